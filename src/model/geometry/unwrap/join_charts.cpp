// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/join_charts.h"

#include <algorithm>
#include <map>
#include <optional>
#include <queue>

#include "model/geometry/unwrap/outline.h"

namespace cei3d {
namespace {

constexpr double kLittleStretch = 1.05;  // L2, of a union whose parts are stretched less
constexpr double kMinFullness = 0.7;     // of a union
constexpr double kMinShared = 0.25;      // of the smaller chart's border, shared with the other

class Joiner {
 public:
  Joiner(const FaceGraph& graph, const Flattener& flattener, std::vector<FlatChart> charts)
      : graph_(graph),
        flattener_(flattener),
        charts_(std::move(charts)),
        chart_of_(graph.size()),
        area_(charts_.size(), 0.0) {
    for (uint32_t c = 0; c < charts_.size(); ++c)
      for (const uint32_t f : charts_[c].faces) chart_of_[f] = c, area_[c] += graph.areas[f];
  }

  std::vector<FlatChart> run() {
    using Item = std::pair<double, uint32_t>;  // area, chart
    std::priority_queue<Item, std::vector<Item>, std::greater<>> order;
    for (uint32_t c = 0; c < charts_.size(); ++c) order.push({area_[c], c});
    while (!order.empty()) {
      const auto [area, c] = order.top();
      order.pop();
      if (area != area_[c] || charts_[c].faces.empty()) continue;  // has become another one since
      if (const auto into = join(c)) order.push({area_[*into], *into});
    }
    std::erase_if(charts_, [](const FlatChart& c) { return c.faces.empty(); });
    return std::move(charts_);
  }

 private:
  struct Neighbor {
    double shared;
    uint32_t chart;
  };

  // Those with which a chart shares enough of its border, the longest first.
  std::vector<Neighbor> neighbors_of(uint32_t c) const {
    std::map<uint32_t, double> shared;
    double border = 0;
    for (const uint32_t f : charts_[c].faces)
      for (int k = 0; k < 3; ++k) {
        const uint32_t g = graph_.across[f][k];
        if (g != kNoFace && chart_of_[g] == c) continue;
        border += graph_.edges[f][k];
        if (g != kNoFace) shared[chart_of_[g]] += graph_.edges[f][k];
      }
    std::vector<Neighbor> out;
    for (const auto& [d, length] : shared)
      if (length >= kMinShared * border) out.push_back({length, d});
    std::stable_sort(out.begin(), out.end(), [](auto& a, auto& b) { return a.shared > b.shared; });
    return out;
  }

  // The chart that it has become a part of, if any.
  std::optional<uint32_t> join(uint32_t c) {
    for (const Neighbor& n : neighbors_of(c)) {
      const auto &mine = charts_[c].faces, &other = charts_[n.chart].faces;
      std::vector<uint32_t> both(mine.size() + other.size());
      std::merge(mine.begin(), mine.end(), other.begin(), other.end(), both.begin());
      const double parts = std::max(charts_[c].stretch, charts_[n.chart].stretch);
      auto flat = flattener_.flat_in_one(std::move(both), std::max(parts, kLittleStretch));
      if (!flat || fullness(flat->flat) < kMinFullness) continue;
      for (const uint32_t f : mine) chart_of_[f] = n.chart;
      charts_[n.chart] = std::move(*flat);
      charts_[c] = {};
      area_[n.chart] += area_[c];
      return n.chart;
    }
    return std::nullopt;
  }

  const FaceGraph& graph_;
  const Flattener& flattener_;
  std::vector<FlatChart> charts_;
  std::vector<uint32_t> chart_of_;  // #F
  std::vector<double> area_;        // #charts
};

}  // namespace

std::vector<FlatChart> joined(const FaceGraph& graph, const Flattener& flattener,
                              std::vector<FlatChart> charts) {
  return Joiner(graph, flattener, std::move(charts)).run();
}

}  // namespace cei3d
