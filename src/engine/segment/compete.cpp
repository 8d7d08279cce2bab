// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/compete.h"

#include <algorithm>
#include <limits>

#include "core/math/quantile.h"

namespace cei3d {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();
// Above this number of regions the cheapest quarter may merge at once; below it one pair after the other.
constexpr size_t kFew = 1000;

struct Patch {
  Vec3f mean{0, 0, 0};  // Oklab
  float size = 0;       // points
  Seed seed = Seed::none;
};

struct Border {
  uint32_t a = 0, b = 0;  // patches, a < b
  float length = 0;       // number of graph edges that cross it
  float crease = 0;       // sum of theirs
};

// Result of one round of merges.
struct Round {
  std::vector<uint32_t> next;  // for each region, the region that it is part of afterwards
  // For each region, the cost at which it joined the positive side; kNever: it did not.
  std::vector<float> joined;
};

// Stable, in O(borders + patches).
template <class Key>
void counting_sort(std::vector<Border>& borders, size_t patches, Key key) {
  std::vector<uint32_t> start(patches + 1, 0);
  for (const Border& b : borders) ++start[key(b) + 1];
  for (size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  std::vector<Border> sorted(borders.size());
  for (const Border& b : borders) sorted[start[key(b)]++] = b;
  borders = std::move(sorted);
}

class Competition {
 public:
  Competition(const PointGraph& graph, std::span<const Seed> seeds) : patches_(graph.colors.size()) {
    for (size_t i = 0; i < patches_.size(); ++i) patches_[i] = {graph.colors[i], 1, seeds[i]};
    borders_.reserve(graph.edges.size());
    for (const GraphEdge& e : graph.edges) borders_.push_back({e.a, e.b, 1, e.crease});
    find_best();
  }

  // Returns false when no two regions may merge any more.
  bool merge() {
    const float limit = cost_limit();
    if (!(limit < kNever)) return false;
    rounds_.push_back(apply(unions(limit)));
    contract(rounds_.back().next);
    find_best();
    return true;
  }

  // For each point, the cost at which it joined the positive side: 0 for points that began there, kNever for
  // points that did not. These costs grow in the order of the merges.
  std::vector<float> joined() const {
    std::vector<float> cost(patches_.size());
    for (size_t i = 0; i < cost.size(); ++i) cost[i] = patches_[i].seed == Seed::positive ? 0 : kNever;
    for (auto round = rounds_.rbegin(); round != rounds_.rend(); ++round) {
      std::vector<float> before(round->next.size());
      for (size_t i = 0; i < before.size(); ++i)
        before[i] = round->joined[i] < kNever ? round->joined[i] : cost[round->next[i]];
      cost = std::move(before);
    }
    return cost;
  }

 private:
  float cost(const Border& border) const {
    const Patch &a = patches_[border.a], &b = patches_[border.b];
    if (int(a.seed) * int(b.seed) < 0) return kNever;
    const Vec3f d = a.mean - b.mean;
    return min(a.size, b.size) * (dot(d, d) + square(border.crease / border.length)) / border.length;
  }

  void find_best() {
    best_.assign(patches_.size(), {kNever, 0});
    for (const Border& border : borders_) {
      const float c = cost(border);
      best_[border.a] = std::min(best_[border.a], {c, border.b});
      best_[border.b] = std::min(best_[border.b], {c, border.a});
    }
  }

  // Maximum cost of merges in this round.
  float cost_limit() const {
    std::vector<float> costs(best_.size());
    for (size_t i = 0; i < costs.size(); ++i) costs[i] = best_[i].first;
    const size_t rank = costs.size() > kFew ? costs.size() / 4 : 0;
    const float limit = value_of_rank(costs, rank);
    return limit < kNever ? limit : *std::min_element(costs.begin(), costs.end());
  }

  // For each region, the one it becomes part of in this round. Two regions that are each other's cheapest
  // neighbor merge, together with all whose cheapest neighbor is one of the two, unless they are on the other
  // side.
  std::vector<uint32_t> unions(float limit) const {
    std::vector<uint32_t> into(patches_.size());
    std::vector<Seed> seed(patches_.size());
    const auto in_pair = [&](uint32_t i) {
      return best_[i].first <= limit && best_[best_[i].second].second == i;
    };
    for (uint32_t i = 0; i < into.size(); ++i) {
      into[i] = in_pair(i) ? std::min(i, best_[i].second) : i;
      seed[i] = patches_[i].seed;
      if (into[i] != i && seed[i] != Seed::none) seed[into[i]] = seed[i];
    }
    for (uint32_t i = 0; i < into.size(); ++i) {
      if (!(best_[i].first <= limit) || in_pair(i) || !in_pair(best_[i].second)) continue;
      const uint32_t root = into[best_[i].second];
      if (int(seed[i]) * int(seed[root]) < 0) continue;
      if (seed[i] != Seed::none) seed[root] = seed[i];
      into[i] = root;
    }
    return into;
  }

  // into: for each region, itself or a region that stays.
  Round apply(const std::vector<uint32_t>& into) {
    Round round{std::vector<uint32_t>(patches_.size()), std::vector<float>(patches_.size(), kNever)};
    std::vector<Patch> merged;
    for (uint32_t i = 0; i < into.size(); ++i)
      if (into[i] == i) round.next[i] = uint32_t(merged.size()), merged.push_back(patches_[i]);
    for (uint32_t i = 0; i < into.size(); ++i) {
      if (into[i] == i) continue;
      Patch& m = merged[round.next[i] = round.next[into[i]]];
      const Patch& p = patches_[i];
      m.mean = (m.mean * m.size + p.mean * p.size) / (m.size + p.size);
      m.size += p.size;
      if (m.seed == Seed::none) m.seed = p.seed;
    }
    for (uint32_t i = 0; i < into.size(); ++i) {
      if (patches_[i].seed == Seed::positive || merged[round.next[i]].seed != Seed::positive) continue;
      highest_ = max(highest_, best_[i].first);
      round.joined[i] = highest_;
    }
    patches_ = std::move(merged);
    return round;
  }

  void contract(const std::vector<uint32_t>& next) {
    for (Border& b : borders_) {
      const uint32_t x = next[b.a], y = next[b.b];
      b.a = std::min(x, y);
      b.b = std::max(x, y);
    }
    std::erase_if(borders_, [](const Border& b) { return b.a == b.b; });
    counting_sort(borders_, patches_.size(), [](const Border& b) { return b.b; });
    counting_sort(borders_, patches_.size(), [](const Border& b) { return b.a; });
    size_t kept = 0;
    for (const Border& b : borders_) {
      Border& last = borders_[kept ? kept - 1 : 0];
      if (kept && last.a == b.a && last.b == b.b) {
        last.length += b.length;
        last.crease += b.crease;
      } else {
        borders_[kept++] = b;
      }
    }
    borders_.resize(kept);
  }

  std::vector<Patch> patches_;
  std::vector<Border> borders_;  // ordered by a, then b
  // For each region: the cost of its cheapest border, and the region beyond it.
  std::vector<std::pair<float, uint32_t>> best_;
  std::vector<Round> rounds_;
  float highest_ = 0;  // highest cost so far at which a region joined the positive side
};

// The cost before the step that is largest in proportion. Steps up to a part of a few points are noise.
float before_largest_step(std::vector<float> joined) {
  std::sort(joined.begin(), joined.end());
  const size_t finite = size_t(std::lower_bound(joined.begin(), joined.end(), kNever) - joined.begin());
  const size_t seeds = size_t(std::upper_bound(joined.begin(), joined.end(), 0.0f) - joined.begin());
  const size_t smallest = std::max(4 * seeds, joined.size() / 1000);
  float best = kNever, largest = 1;
  for (size_t i = std::max<size_t>(smallest, 1); i < finite; ++i) {
    const float step = joined[i] / max(joined[i - 1], 1e-12f);
    if (step > largest) largest = step, best = joined[i - 1];
  }
  return best;
}

}  // namespace

std::vector<uint8_t> compete(const PointGraph& graph, std::span<const Seed> seeds) {
  Competition competition(graph, seeds);
  while (competition.merge()) {
  }
  const std::vector<float> joined = competition.joined();
  const bool contested = std::find(seeds.begin(), seeds.end(), Seed::negative) != seeds.end();
  const float limit = contested ? std::numeric_limits<float>::max() : before_largest_step(joined);
  std::vector<uint8_t> positive(joined.size());
  for (size_t i = 0; i < positive.size(); ++i) positive[i] = joined[i] <= limit && joined[i] < kNever;
  return positive;
}

}  // namespace cei3d
