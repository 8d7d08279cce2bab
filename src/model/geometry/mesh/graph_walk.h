// SPDX-License-Identifier: Apache-2.0
// A random walk on a graph that ends at seeds. [Grady 2006]
#pragma once

#include <span>
#include <vector>

namespace cei3d {

struct WalkEdge {
  int a = 0, b = 0;   // different nodes
  double weight = 0;  // above 0
};

// The walk ends at the node with this weight, beside those of the edges that leave it and of other seeds
// there.
struct WalkSeed {
  int node = 0;
  double weight = 0;  // above 0
  double value = 0;
};

// For each of n nodes the expected value of the seed at which a walk from there ends. Error: nodes from which
// no seed is reached.
std::vector<double> walk_to_seeds(int n, std::span<const WalkEdge> edges, std::span<const WalkSeed> seeds);

}  // namespace cei3d
