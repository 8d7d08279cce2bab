// SPDX-License-Identifier: Apache-2.0
#include "engine/render/radiance_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/math/rng.h"
#include "engine/render/lobe_planes.h"
#include "engine/render/test_balls.h"

namespace cei3d {
namespace {

// A light whose lobes are broad beside the lobe of the table, which then changes little.
TEST(RadianceMap, IsTheRadianceOfABroadLight) {
  SgMixture light = some_sky();
  double largest = 0;
  for (SgLobe& lobe : light.lobes) lobe.lambda = std::min(lobe.lambda, 4.0f);
  const std::vector<float> planes = lobe_planes(light);
  const int n = int(light.lobes.size());
  const DirectionMap map = radiance_map(make_device(), {planes.data(), n, padded_to_panels(n)});
  double error = 0;
  constexpr int kDirections = 2000;
  for (uint64_t i = 0; i < kDirections; ++i) {
    Rng rng(3, 0, i);
    const Vec3f d = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}), got = map.at(d),
                truth = radiance(light, d);
    for (int c = 0; c < 3; ++c) {
      error += std::abs(double(got[c] - truth[c])) / (3 * kDirections);
      largest = std::max(largest, double(truth[c]));
    }
  }
  EXPECT_LT(error, 0.01 * largest);
}

}  // namespace
}  // namespace cei3d
