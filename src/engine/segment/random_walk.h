// SPDX-License-Identifier: Apache-2.0
// The border of a part: the score of a point is the probability that a random walker reaches a positive seed
// before a negative one; steps across color differences are unlikely. [Grady 2006]
#pragma once

#include <span>
#include <vector>

#include "engine/segment/compete.h"
#include "engine/segment/point_graph.h"

namespace cei3d {

// prior: #N, [0, 1], initial belief; it decides far from the seeds. Returns #N scores in [0, 1]; they cross
// one half in the middle of a blurred border, finer than the spacing of points.
std::vector<float> random_walk(const PointGraph&, std::span<const Seed> seeds, std::span<const float> prior);

}  // namespace cei3d
