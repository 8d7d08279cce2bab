// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/sky.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/math/octahedron.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

Vec3f some_direction(uint64_t i) {
  Rng rng(8, 0, i);
  return normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
}

TEST(Octahedron, FoldsBackToTheSameDirection) {
  for (uint64_t i = 0; i < 2000; ++i) {
    const Vec3f d = some_direction(i);
    const Vec2f p = octahedron_from_direction(d);
    EXPECT_LE(std::max(std::abs(p.x), std::abs(p.y)), 1.0f);
    EXPECT_LT(length(direction_from_octahedron(p) - d), 1e-6f);
  }
  EXPECT_LT(length(direction_from_octahedron({1, -1}) - Vec3f{0, 0, -1}), 1e-6f);
}

TEST(Sky, TheNearestDirectionsAreAround) {
  const std::vector<Vec3f>& sky = sky_directions();
  const auto threshold = std::cos(0.3f);  // directions are .16 apart
  for (uint64_t i = 0; i < 2000; ++i) {
    const Vec3f d = some_direction(i);
    const auto nearest = std::max_element(
        sky.begin(), sky.end(), [&](const Vec3f& a, const Vec3f& b) { return dot(a, d) < dot(b, d); });
    const SkyNeighbors& around = sky_around(d);
    EXPECT_NE(std::find(around.begin(), around.end(), nearest - sky.begin()), around.end());
    for (const uint16_t k : around) EXPECT_GT(dot(sky[k], d), threshold);
  }
}

}  // namespace
}  // namespace cei3d
