// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/point_index.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/math/rng.h"

namespace cei3d {
namespace {

std::vector<Vec3f> random_points(int n, uint64_t seed) {
  std::vector<Vec3f> p(n);
  for (int i = 0; i < n; ++i) {
    Rng rng(seed, 0, i);
    p[i] = Vec3f{rng.uniform(), rng.uniform(), rng.uniform()} * 2.0f - Vec3f{1, 1, 1};
  }
  return p;
}

TEST(PointIndex, FindsWhatBruteForceFindsOnceEach) {
  const std::vector<Vec3f> points = random_points(2000, 1), queries = random_points(300, 2);
  for (const float cell : {0.05f, 0.3f}) {
    const PointIndex index(points, cell);
    for (const float radius : {cell, 0.4f * cell}) {
      for (const Vec3f q : queries) {
        std::vector<size_t> expected, found;
        for (size_t i = 0; i < points.size(); ++i)
          if (dot(points[i] - q, points[i] - q) < radius * radius) expected.push_back(i);
        EXPECT_FALSE(index.any_within(q, radius, [&](size_t i) { return found.push_back(i), false; }));
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, expected);
      }
    }
  }
}

TEST(PointIndex, StopsAtTheFirstThatIsAccepted) {
  const std::vector<Vec3f> points(10, Vec3f{0.1f, 0.1f, 0.1f});
  const PointIndex index(points, 0.5f);
  int visited = 0;
  EXPECT_TRUE(index.any_within({0, 0, 0}, 0.5f, [&](size_t i) { return ++visited, i == 3; }));
  EXPECT_EQ(visited, 4);  // ascending within a cell
}

TEST(PointIndex, EmptyAndFarAwayQueriesFindNothing) {
  EXPECT_FALSE(PointIndex().any_within({0, 0, 0}, 1, [](size_t) { return true; }));
  const PointIndex index(random_points(50, 3), 0.1f);
  EXPECT_FALSE(index.any_within({1e20f, -1e20f, 0}, 0.1f, [](size_t) { return true; }));
}

}  // namespace
}  // namespace cei3d
