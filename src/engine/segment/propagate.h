// SPDX-License-Identifier: Apache-2.0
// Propagates a part from clicks in one view: the mask there is carried to the handler points, which give
// prompts for the next view, and so on around the part. [paper Algorithm 1] The algorithm does not say how
// prompts are chosen: here hidden points are ignored, and prompts are spread over the part. How views are
// chosen and combined is in view_plan.h.
#pragma once

#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/math/camera.h"
#include "engine/segment/prompts.h"
#include "engine/segment/view_plan.h"
#include "engine/segment/view_segmenter.h"
#include "model/geometry/shape/handlers.h"
#include "model/geometry/shape/surface.h"

namespace cei3d {

struct PropagateRequest {
  std::vector<Camera> cameras;  // of the views that the segmenter knows, unit frame
  int first = 0;                // index of the clicked view
  Prompts clicks;               // in the clicked view, at least one positive unless there is a mask
  Image mask;  // of the part in the clicked view, 1 channel, inside where >= 0.5; may be empty
  ViewPlan plan;
};

struct PropagateReport {
  std::vector<int> views;  // views that voted, in order; the clicked one first
  // Views that gave nothing: the mask contradicted the earlier votes, or no prompt could be seen.
  std::vector<int> refused;
};

struct PropagateResult {
  std::vector<float> scores;  // #handlers, [0, 1]; 0.5 where no view gave information
  PropagateReport report;
};

// handlers: on the surface's present shape. Errors: the first view's mask contains no handler point;
// cancelled.
PropagateResult propagate(const HandlerPoints& handlers, const Surface&, const PropagateRequest&,
                          ViewSegmenter&, Progress&);

}  // namespace cei3d
