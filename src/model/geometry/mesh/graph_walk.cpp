// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/graph_walk.h"

#include <algorithm>

#include "model/geometry/mesh/sparse.h"

namespace cei3d {

// The values are harmonic: at each node the mean of its neighbors' and of its seeds', by weight.
std::vector<double> walk_to_seeds(int n, std::span<const WalkEdge> edges, std::span<const WalkSeed> seeds) {
  std::vector<SparseEntry> entries;
  entries.reserve(3 * edges.size() + seeds.size());
  for (const WalkEdge& e : edges) {
    entries.push_back({e.a, e.a, e.weight});
    entries.push_back({e.b, e.b, e.weight});
    entries.push_back({std::max(e.a, e.b), std::min(e.a, e.b), -e.weight});
  }
  std::vector<double> right(static_cast<size_t>(n));
  for (const WalkSeed& s : seeds) {
    entries.push_back({s.node, s.node, s.weight});
    right[size_t(s.node)] += s.weight * s.value;
  }
  return SparseSolver(n, entries).solve(right);
}

}  // namespace cei3d
