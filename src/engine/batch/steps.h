// SPDX-License-Identifier: Apache-2.0
// The steps that make an object of a catalog. Each has a folder for its results, with step.json in it, whose
// key says what they were made from: a step is done when its folder has the present key.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/base/progress.h"
#include "engine/batch/item.h"
#include "engine/session/session.h"

namespace cei3d {

struct BatchStepTools {
  Session& session;
  Progress& progress;
  // Folder of another step that is done.
  std::function<std::filesystem::path(const std::string& step)> results;
};

struct BatchStep {
  std::string name;  // its folder in the folder of the object: "project", "export/red"
  std::string key;
  std::vector<std::string> needs;  // the steps whose results it reads
  bool kept = true;  // when the object is done; a step that is not kept is made only when needed
  // Makes the results in an empty folder, or in one in which it was interrupted before. Returns what the
  // index shall show.
  std::function<Json(const BatchStepTools&, const std::filesystem::path& out)> run;
};

struct BatchSteps {
  std::vector<BatchStep> steps;  // before each the ones that it needs
  std::string key;               // of all that is kept
  const BatchStep& named(const std::string&) const;
};

// Names, sizes and times of the files of a capture; of a file, of all in its folder. Empty: there is none.
std::string capture_files_hash(const std::filesystem::path& capture);

// capture_hash: of capture_files_hash(). Errors: an edit replays a project that is not there.
BatchSteps batch_steps(const BatchItem&, const std::string& capture_hash, Session&);

}  // namespace cei3d
