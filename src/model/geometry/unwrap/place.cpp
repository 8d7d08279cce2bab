// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/place.h"

#include <algorithm>

namespace cei3d {
namespace {

constexpr int kMaxWords = 64;

// Positions x at which a run of cells from x + run.x meets a taken one: `row` smeared down by the run's
// length.
void add_blocked(const uint64_t* row, int words, const Footprint::Run& run, uint64_t* blocked) {
  uint64_t smeared[kMaxWords];
  std::copy(row, row + words, smeared);
  // In place from the low words up: what is read lies above what was written.
  for (int done = 1; done < run.length;) {
    const int step = std::min(done, run.length - done);
    or_shifted_down(smeared, smeared, words, step);
    done += step;
  }
  or_shifted_down(blocked, smeared, words, run.x);
}

// The lowest bit that is not set, below `end`; -1: none.
int first_clear(const uint64_t* bits, int end) {
  for (int w = 0; w * 64 < end; ++w)
    if (~bits[w]) {
      const int x = w * 64 + __builtin_ctzll(~bits[w]);
      return x < end ? x : -1;
    }
  return -1;
}

}  // namespace

Footprint footprint_of(const BitGrid& cells) {
  Footprint out{cells.width(), cells.height(), {}};
  for (int y = 0; y < cells.height(); ++y)
    for (int x = 0; x < cells.width();) {
      if (!cells.at(x, y)) {
        ++x;
        continue;
      }
      const int from = x;
      while (x < cells.width() && cells.at(x, y)) ++x;
      out.runs.push_back({y, from, x - from});
    }
  std::stable_sort(out.runs.begin(), out.runs.end(),
                   [](const auto& a, const auto& b) { return a.length > b.length; });
  return out;
}

std::optional<Place> lowest_place(const BitGrid& taken, const Footprint& piece, int limit) {
  const int end = taken.width() - piece.width + 1, words = (std::max(end, 1) + 63) / 64;
  for (int y = 0; y < limit && y + piece.height <= taken.height() && end > 0; ++y) {
    uint64_t blocked[kMaxWords] = {};
    int free = 0;
    for (size_t r = 0; r < piece.runs.size() && free >= 0; ++r) {
      add_blocked(taken.row(y + piece.runs[r].y), taken.words(), piece.runs[r], blocked);
      if (r % 4 == 3 || r + 1 == piece.runs.size()) free = first_clear(blocked, std::min(end, words * 64));
    }
    if (free >= 0) return Place{free, y};
  }
  return std::nullopt;
}

void take(BitGrid& taken, const Footprint& piece, Place at, int grow) {
  for (const Footprint::Run& run : piece.runs)
    for (int y = std::max(0, at.y + run.y - grow); y <= std::min(taken.height() - 1, at.y + run.y + grow);
         ++y)
      for (int x = std::max(0, at.x + run.x - grow);
           x < std::min(taken.width(), at.x + run.x + run.length + grow); ++x)
        taken.set(x, y);
}

}  // namespace cei3d
