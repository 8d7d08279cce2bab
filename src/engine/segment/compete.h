// SPDX-License-Identifier: Apache-2.0
// Regions of like color grow, merge and compete for what the user did not click on.
//
// Every point begins as a region of its own. Again and again the two neighbors merge that differ least: by
// the squared difference of their mean colors, times the smaller one's size, over the length of their common
// border [Mumford and Shah 1989; Koepfler et al. 1994]. Small islands are swallowed early, noise averages
// out, a blurred border has no gaps. A region that holds a positive click never merges with one that holds a
// negative one; so in the end everything belongs to one or the other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/segment/point_graph.h"

namespace cei3d {

enum class Seed : int8_t { negative = -1, none = 0, positive = 1 };

// seeds: #N, at least one positive. Returns #N, 1 where the point belongs to the positive side. Without
// negative seeds the part is what the positive ones had merged with just before the step that differed most,
// in proportion, from the one before.
std::vector<uint8_t> compete(const PointGraph&, std::span<const Seed> seeds);

}  // namespace cei3d
