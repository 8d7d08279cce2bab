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

int longest_free(const BitGrid& cells, int y) {
  int longest = 0, run = 0;
  for (int x = 0; x < cells.width(); ++x) {
    run = cells.at(x, y) ? 0 : run + 1;
    longest = std::max(longest, run);
  }
  return longest;
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
  // By the golden ratio neighbors in the order are far apart in the piece.
  constexpr uint32_t kGolden = 2654435769;  // 2^32 / 1.618
  std::vector<std::pair<uint32_t, Footprint::Run>> order;
  for (const Footprint::Run& run : out.runs) order.push_back({uint32_t(order.size()) * kGolden, run});
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (size_t i = 0; i < order.size(); ++i) out.runs[i] = order[i].second;
  return out;
}

Taken::Taken(BitGrid cells) : cells_(std::move(cells)), free_(size_t(cells_.height())) {
  for (int y = 0; y < cells_.height(); ++y) free_[size_t(y)] = longest_free(cells_, y);
}

bool Taken::too_full(const Footprint& piece, int y) const {
  return std::any_of(piece.runs.begin(), piece.runs.end(),
                     [&](const Footprint::Run& run) { return free_[size_t(y + run.y)] < run.length; });
}

std::optional<Place> Taken::lowest_place(const Footprint& piece, int limit) const {
  const int end = cells_.width() - piece.width + 1, words = (std::max(end, 1) + 63) / 64;
  for (int y = 0; y < limit && y + piece.height <= cells_.height() && end > 0; ++y) {
    if (too_full(piece, y)) continue;
    uint64_t blocked[kMaxWords] = {};
    int free = 0;
    for (size_t r = 0; r < piece.runs.size() && free >= 0; ++r) {
      add_blocked(cells_.row(y + piece.runs[r].y), cells_.words(), piece.runs[r], blocked);
      if (r % 4 == 3 || r + 1 == piece.runs.size()) free = first_clear(blocked, std::min(end, words * 64));
    }
    if (free >= 0) return Place{free, y};
  }
  return std::nullopt;
}

void Taken::take(const Footprint& piece, Place at, int grow) {
  for (const Footprint::Run& run : piece.runs)
    for (int y = std::max(0, at.y + run.y - grow); y <= std::min(cells_.height() - 1, at.y + run.y + grow);
         ++y)
      for (int x = std::max(0, at.x + run.x - grow);
           x < std::min(cells_.width(), at.x + run.x + run.length + grow); ++x)
        cells_.set(x, y);
  for (int y = std::max(0, at.y - grow); y < std::min(cells_.height(), at.y + piece.height + grow); ++y)
    free_[size_t(y)] = longest_free(cells_, y);
}

}  // namespace cei3d
