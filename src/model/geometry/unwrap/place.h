// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "model/geometry/unwrap/bit_grid.h"

namespace cei3d {

// The cells that a piece covers, as runs of cells in rows, the longest first: they fail first.
struct Footprint {
  struct Run {
    int y, x, length;
  };
  int width = 0, height = 0;
  std::vector<Run> runs;
};
Footprint footprint_of(const BitGrid& cells);

struct Place {
  int x, y;
};
// The lowest free place, the leftmost of these, at which no cell of the piece is taken; none at a height of
// `limit` or more.
std::optional<Place> lowest_place(const BitGrid& taken, const Footprint& piece, int limit);

// Takes the cells of the piece there and those up to `grow` cells away along both axes.
void take(BitGrid& taken, const Footprint& piece, Place at, int grow);

}  // namespace cei3d
