// SPDX-License-Identifier: Apache-2.0
#include "model/light/refine_colors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/math/sg.h"
#include "model/light/fit.h"

namespace cei3d {
namespace {

constexpr int kHeight = 64;

// A sky with a sun of one pixel, brighter than all of the sky.
Image sunny() {
  Image map(2 * kHeight, kHeight, 3);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < map.width; ++x) {
      const Vec3f d = env_direction(float(x) + 0.5f, float(y) + 0.5f, map.width, kHeight);
      for (int c = 0; c < 3; ++c) map.at(x, y)[c] = 0.3f + 0.2f * d.z + 0.1f * d[c];
    }
  for (int c = 0; c < 3; ++c) map.at(37, 20)[c] = 4000;
  return map;
}

// Mean error, relative, of the light seen through Gaussians of a lambda between those of the fit, summed
// pixel by pixel.
double error_through(float lambda, const SgMixture& light, const Image& map) {
  const Image drawn = lat_long(light, kHeight * 4), truth = env_resample(map, kHeight);
  const auto seen = [&](const Image& m, Vec3f towards) {
    double sum = 0;
    for (int y = 0; y < m.height; ++y)
      for (int x = 0; x < m.width; ++x) {
        const Vec3f d = env_direction(float(x) + 0.5f, float(y) + 0.5f, m.width, m.height);
        sum += double(m.at(x, y)[1]) * std::exp(lambda * (dot(towards, d) - 1)) *
               env_solid_angle(y, m.width, m.height);
      }
    return sum;
  };
  double error = 0, total = 0;
  for (int i = 0; i < 60; ++i) {
    const float z = -0.95f + 1.9f * float(i) / 59, a = 1.7f * float(i), r = std::sqrt(1 - z * z);
    const Vec3f towards{r * std::cos(a), r * std::sin(a), z};
    const double want = seen(truth, towards);
    error += std::abs(seen(drawn, towards) - want);
    total += want;
  }
  return error / total;
}

TEST(RefineColors, KeepsTheEnergyOfASun) {
  const Image map = sunny();
  const SgMixture light = fit_lobes(make_device(), map);
  // .62 by the square roots alone, in which the sun is little
  for (const float lambda : {2.0f, 20.0f}) EXPECT_LT(error_through(lambda, light, map), 0.07);
}

TEST(RefineColors, FindsTheColorsOfLobesWhoseAxesAndSharpnessesAreRight) {
  SgMixture truth{{{normalize(Vec3f{1, 1, 1}), 6, {1, 0.5f, 0.2f}},
                   {{0, -0.6f, 0.8f}, 30, {2, 2, 3}},
                   {{-1, 0, 0}, 12, {0.2f, 1, 0}}}};
  SgMixture start = truth;
  for (SgLobe& lobe : start.lobes) lobe.mu = lobe.mu * 0.7f + Vec3f{0.1f, 0, 0.1f};
  const SgMixture got = refine_colors(start, lat_long(truth, 128));
  for (size_t k = 0; k < truth.lobes.size(); ++k)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got.lobes[k].mu[c], truth.lobes[k].mu[c], 0.01) << k;
}

}  // namespace
}  // namespace cei3d
