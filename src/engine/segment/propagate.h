// SPDX-License-Identifier: Apache-2.0
// A part from clicks in one view: its mask there is carried to the handler points, they say where to prompt
// in the next view, and so on around the part. [paper Algorithm 1; with what it leaves open: hidden points
// take no part, the views vote, a mask that contradicts what is known has no vote]
#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/math/camera.h"
#include "engine/segment/prompts.h"
#include "engine/segment/view_segmenter.h"
#include "model/geometry/shape/handlers.h"
#include "model/geometry/shape/surface.h"

namespace cei3d {

struct PropagateRequest {
  std::vector<Camera> cameras;  // of the views that the segmenter knows, unit-sphere frame
  int first = 0;                // the clicked one
  Prompts clicks;               // in it, at least one positive
  int max_views = 10;           // that are segmented: the segmenter is the cost
};

struct PropagateReport {
  std::vector<int> views;    // that voted, in order; the clicked one first
  std::vector<int> refused;  // whose masks contradicted what was known
};

struct PropagateResult {
  std::vector<float> scores;  // #handlers, [0, 1]: belongs to the part; 0.5 where no view told anything
  PropagateReport report;
};

// handlers: of the surface's present shape. Errors: the first view's mask holds no handler point; cancelled.
PropagateResult propagate(const HandlerPoints& handlers, const Surface&, const PropagateRequest&,
                          ViewSegmenter&, Progress&);

}  // namespace cei3d
