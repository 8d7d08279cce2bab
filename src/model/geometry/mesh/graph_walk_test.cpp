// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/graph_walk.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace cei3d {
namespace {

// On a path a walk reaches the one end before the other with a probability that falls linearly with the sum
// of the resistances, which are the inverse weights.
TEST(GraphWalk, DividesAPathByItsResistances) {
  const std::vector<WalkEdge> path{{0, 1, 1.0}, {2, 1, 0.25}, {2, 3, 0.5}, {3, 4, 1.0}};
  const std::vector<WalkSeed> ends{{0, 1e9, 0}, {4, 1e9, 1}};
  const std::vector<double> x = walk_to_seeds(5, path, ends);
  const double expected[] = {0, 1.0 / 8, 5.0 / 8, 7.0 / 8, 1};
  for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], expected[i], 1e-6) << i;
}

// A seed whose weight is that of the edges of its node ends half of the walks that pass.
TEST(GraphWalk, PassesWeakSeeds) {
  const std::vector<WalkEdge> path{{0, 1, 1.0}};
  const std::vector<WalkSeed> seeds{{0, 1.0, 0.0}, {1, 1e9, 1.0}};
  EXPECT_NEAR(walk_to_seeds(2, path, seeds)[0], 0.5, 1e-6);
}

TEST(GraphWalk, RefusesAPartWithoutSeeds) {
  const std::vector<WalkEdge> two_parts{{0, 1, 1.0}, {2, 3, 1.0}};
  const std::vector<WalkSeed> seeds{{0, 1.0, 0.0}};
  EXPECT_THROW(walk_to_seeds(4, two_parts, seeds), Error);
}

}  // namespace
}  // namespace cei3d
