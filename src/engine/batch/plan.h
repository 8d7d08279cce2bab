// SPDX-License-Identifier: Apache-2.0
// Manifests from folders of captures.
#pragma once

#include <vector>

#include "engine/batch/manifest.h"
#include "engine/session/session.h"

namespace cei3d {

struct BatchRefusal {
  std::string id, reason;
};
struct BatchPlan {
  std::vector<Json> lines;
  std::vector<BatchRefusal> refused;  // captures that `reconstruct` would refuse; they have lines, too
  size_t views = 0;
  double memory_gib = 0;  // of the largest object, an estimate
  Json json() const;
};

// captures: folders or camera files of captures, or one manifest (.jsonl, .csv). An id is the name of the
// folder, with a number behind it when it is taken. look: check every capture, which takes seconds each;
// without, the lines say nothing of views and memory.
BatchPlan batch_plan(const std::vector<std::filesystem::path>& captures, bool look, Session&, Progress&);

}  // namespace cei3d
