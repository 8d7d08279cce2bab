// SPDX-License-Identifier: Apache-2.0
// Places for pieces of an atlas: which cells they cover and where these are free.
#pragma once

#include <optional>
#include <vector>

#include "model/geometry/unwrap/bit_grid.h"

namespace cei3d {

// The cells that a piece covers, as runs of cells in rows, in an order in which neighbors are far apart:
// where one run meets a taken cell, those next to it mostly do, too, and say nothing new.
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

// A grid that fills up.
class Taken {
 public:
  explicit Taken(BitGrid cells);

  const BitGrid& cells() const { return cells_; }
  // The lowest free place, the leftmost of these, at which no cell of the piece is taken; none at a height of
  // `limit` or more.
  std::optional<Place> lowest_place(const Footprint& piece, int limit) const;
  // Takes the cells of the piece there and those up to `grow` cells away along both axes.
  void take(const Footprint& piece, Place at, int grow);

 private:
  bool too_full(const Footprint& piece, int y) const;

  BitGrid cells_;
  std::vector<int> free_;  // cells of the longest free run of every row, which rules out most places
};

}  // namespace cei3d
