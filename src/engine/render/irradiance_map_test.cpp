// SPDX-License-Identifier: Apache-2.0
#include "engine/render/irradiance_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/math/rng.h"
#include "core/math/sg.h"
#include "model/light/sg_mixture.h"

namespace cei3d {
namespace {

Vec3f some_direction(Rng& rng) { return normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()}); }

TEST(IrradianceMap, IsTheSumOverTheLobes) {
  constexpr int kLobes = 32;
  for (const float sharpness : {0.5f, 20.0f, kSharpestLobe}) {
    std::vector<float> planes(7 * kLobes, 0.0f);
    Rng rng(5, 0, uint64_t(sharpness));
    const Vec3f axis = some_direction(rng);
    const float mu = std::max(1.0f, sharpness / (2 * kPi));
    const float row[] = {axis.x, axis.y, axis.z, sharpness, mu, 0.5f * mu, 0};
    for (int j = 0; j < 7; ++j) planes[size_t(j) * kLobes] = row[j];
    const IrradianceMap map(make_device(), {planes.data(), 1, kLobes});
    double mean = 0, worst = 0;
    constexpr int kNormals = 4000;
    for (int i = 0; i < kNormals; ++i) {
      const Vec3f n = some_direction(rng), got = map.at(n);
      const double truth = mu * std::max(sg_irradiance(double(sharpness), double(dot(n, axis))), 0.0);
      const double error = std::abs(got.x - truth);
      EXPECT_FLOAT_EQ(got.y, 0.5f * got.x);
      EXPECT_EQ(got.z, 0);
      mean += error / kNormals;
      worst = std::max(worst, error);
    }
    const double largest = mu * sg_irradiance(double(sharpness), 1.0);
    EXPECT_LT(mean, 0.0005 * largest) << sharpness;
    // A sun at the horizon: a kink is off by up to a quarter of a cell, whose diagonals are up to .064 long.
    EXPECT_LT(worst, 0.016 * largest) << sharpness;
  }
}

TEST(IrradianceMap, IsDarkWithoutLight) { EXPECT_EQ(IrradianceMap().at({0, 0, 1}).x, 0); }

}  // namespace
}  // namespace cei3d
