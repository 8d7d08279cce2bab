// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/random_walk.h"

#include <algorithm>
#include <cmath>

#include "core/math/quantile.h"
#include "model/geometry/mesh/graph_walk.h"

namespace cei3d {
namespace {

// A step of a third of the typical one about halves the weight: walkers take the smoothest paths, which exist
// across noise but not across borders. Results hardly change between half and twice that.
constexpr float kSharpness = 8;
constexpr float kMinWeight = 1e-6f;    // minimum weight of an edge
constexpr double kPrior = 1e-5;        // weight of the prior at a point
constexpr double kSeed = 1e3;          // weight of a seed
constexpr float kMinTypical = 0.005f;  // Oklab; objects of flat colors have smaller steps, which mean nothing

float typical_step(const PointGraph& graph) {
  if (graph.edges.empty()) return kMinTypical;
  std::vector<float> steps(graph.edges.size());
  for (size_t i = 0; i < steps.size(); ++i) steps[i] = graph.edges[i].step();
  return max(median(std::move(steps)), kMinTypical);
}

}  // namespace

std::vector<float> random_walk(const PointGraph& graph, std::span<const Seed> seeds,
                               std::span<const float> prior) {
  const int n = int(graph.colors.size());
  const float typical = typical_step(graph);
  std::vector<WalkEdge> edges;
  edges.reserve(graph.edges.size());
  for (const GraphEdge& e : graph.edges)
    if (e.length <= 2)
      edges.push_back({int(e.a), int(e.b), std::exp(-kSharpness * square(e.step() / typical)) + kMinWeight});
  std::vector<WalkSeed> ends;
  ends.reserve(2 * size_t(n));
  for (int i = 0; i < n; ++i) {
    ends.push_back({i, kPrior, prior[i]});
    if (seeds[i] != Seed::none) ends.push_back({i, kSeed, seeds[i] == Seed::positive ? 1.0 : 0.0});
  }
  const std::vector<double> x = walk_to_seeds(n, edges, ends);
  std::vector<float> scores(n);
  for (int i = 0; i < n; ++i) scores[i] = clamp(float(x[i]), 0.0f, 1.0f);
  return scores;
}

}  // namespace cei3d
