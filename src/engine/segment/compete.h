// SPDX-License-Identifier: Apache-2.0
// Region growing with competition: regions of similar color merge until every point belongs to a positive or
// a negative click.
//
// Every point begins as a region of its own. Repeatedly the two neighbors merge that differ least: by the
// squared difference of their mean colors, times the size of the smaller one, over the length of their common
// border [Mumford and Shah 1989; Koepfler et al. 1994]. Small islands are absorbed early, noise averages out,
// and blurred borders have no gaps. A region with a positive click never merges with one with a negative
// click, so in the end every point belongs to one or the other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/segment/point_graph.h"

namespace cei3d {

enum class Seed : int8_t { negative = -1, none = 0, positive = 1 };

// seeds: #N, at least one positive. Returns #N, 1 where the point belongs to the positive side. Without
// negative seeds the part is the positive region before the merge with the largest cost relative to the merge
// before.
std::vector<uint8_t> compete(const PointGraph&, std::span<const Seed> seeds);

}  // namespace cei3d
