// SPDX-License-Identifier: Apache-2.0
// Scores for the points that no view told anything about.
#pragma once

#include <vector>

#include "model/geometry/handlers.h"

namespace cei3d {

// Points whose score is 0.5 exactly take the mean of those around them on their side of the surface, ring by
// ring; what nothing reaches gets 0.
void spread_scores(const HandlerPoints&, std::vector<float>& scores);

}  // namespace cei3d
