// SPDX-License-Identifier: Apache-2.0
// The paper's evaluation of one capture: novel views, a paint and a part edit, ablations, fewer and smaller
// photographs. Each row of its tables is an object or an edit that a Session makes and `eval` scores.
// Finished rows are kept in the folder, so that an interrupted job continues where it stopped.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json.h"
#include "engine/session/session.h"

namespace cei3d {

// Folders of true images and masks of an edit, as in EvalRequest; both or none.
struct EditTruth {
  std::filesystem::path pictures, masks;
};
struct PartTrial {
  PartCommand command;  // with a color
  EditTruth truth;
};

struct EvaluationRequest {
  std::filesystem::path capture, out;
  std::string format;             // of the capture; empty: detected from the files
  ReconstructOptions options;     // of the object; the other objects differ in views, downscale and seconds
  std::filesystem::path project;  // existing object of this capture to evaluate; empty: reconstruct one
  double trial_seconds = 0;       // for each object from fewer or smaller photographs; 0: options.seconds
  std::optional<PaintStroke> paint;  // none: no paint edit is scored
  EditTruth paint_truth;
  std::optional<PartTrial> part;
  bool ablations = true;               // also paint without parts of the method
  bool parts = true;                   // several captures: also their own part edits
  bool applications = false;           // also another roughness, a turned light, a dragged point
  std::vector<int> views, downscales;  // one object each
  NetworkFiles networks;
  int samples = 2;
};

struct EvaluationRow {
  std::string name;     // of its folder of images: "paint-none"
  std::string what;     // short description
  std::string skipped;  // why there are no scores; empty: scored
  double seconds = 0;   // of the edit, or of the reconstruction
  Json details;         // report of the edit or of the reconstruction
  EvalReport scores;    // of held-out views, and of the edit if there is one
  Json json() const;
};
// Error: what json() does not write, an unknown key. what: the JSON, in errors.
EvaluationRow evaluation_row_from_json(const Json&, const std::string& what = "A row");

struct EvaluationReport {
  std::string capture;
  std::filesystem::path folder;  // that the report is in; not in its JSON
  EvaluationRow object;          // all views, full size
  // The method, then without handler points, without disentangled properties.
  std::vector<EvaluationRow> paint;
  std::vector<EvaluationRow> part;          // the method, then without propagation to other views
  std::vector<EvaluationRow> applications;  // roughness, light, drag
  std::vector<EvaluationRow> views;  // objects from fewer photographs, with the paint edit if there is one
  std::vector<EvaluationRow> sizes;  // objects from smaller photographs, likewise
  Json json() const;
  std::string markdown() const;
};

// Writes OUT/report.md, report.json and images/. Usage errors: no such view, a folder of another job. An
// interrupted Error keeps finished rows.
EvaluationReport evaluate_capture(Session&, const EvaluationRequest&, Progress&);

}  // namespace cei3d
