// SPDX-License-Identifier: Apache-2.0
// The paper's evaluation of one capture as one job: novel views, a painted edit, what the method is without
// its parts, and how few or how small photographs will do. Each row of its tables is an object or an edit
// that a Session makes and `eval` scores. What is finished is kept in the folder: a job that was interrupted
// goes on where it was.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/session/session.h"

namespace cei3d {

// Pictures of how an edit should look and masks of where it should be, as in EvalRequest; both or none.
struct EditTruth {
  std::filesystem::path pictures, masks;
};
struct PartTrial {
  PartCommand command;  // with a color
  EditTruth truth;
};

struct EvaluationRequest {
  std::filesystem::path capture, out;
  std::string format;                // of the capture; empty: told by the files
  ReconstructOptions options;        // of the object; the trials differ in views, downscale and seconds
  std::filesystem::path project;     // a finished object of this capture to evaluate; empty: one is made
  double trial_seconds = 0;          // of each object from fewer or smaller photographs; 0: options.seconds
  std::optional<PaintStroke> paint;  // without it no edit is scored
  EditTruth paint_truth;
  std::optional<PartTrial> part;
  bool ablations = true;               // of the paint: also without the method's parts
  std::vector<int> views, downscales;  // one object each
  NetworkFiles networks;
  int samples = 2;
};

struct EvaluationRow {
  std::string name;     // of its folder of pictures: "paint-none"
  std::string what;     // in a few words
  std::string skipped;  // why there are no figures; empty: there are
  double seconds = 0;   // of the edit, or of making the object
  Json details;         // what edit or reconstruction say of themselves
  EvalReport scores;    // of held-out views; with an edit also how it did
  Json json() const;
};
EvaluationRow evaluation_row_from_json(const Json&);  // throws Json::exception

struct EvaluationReport {
  std::string capture;
  EvaluationRow object;  // all views, full size
  // The method, then without handler points, without disentangled properties
  std::vector<EvaluationRow> paint;
  std::vector<EvaluationRow> part;  // the method, then without propagation to other views
  std::vector<EvaluationRow> views,
      sizes;  // objects from fewer, from smaller photographs; painted where there is paint
  Json json() const;
  std::string markdown() const;
};

// Writes OUT/report.md, report.json and pictures/. Usage errors: no such view, another job's folder. An
// interrupted Error keeps what there is.
EvaluationReport evaluate_capture(Session&, const EvaluationRequest&, Progress&);

}  // namespace cei3d
