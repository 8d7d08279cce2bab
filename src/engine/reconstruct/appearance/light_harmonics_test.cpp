// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/light_harmonics.h"

#include <gtest/gtest.h>

#include "core/math/rng.h"
#include "core/math/rotation.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

std::vector<Vec3f> some_light(int height) {
  std::vector<Vec3f> light;
  for (int i = 0; i < 2 * height * height; ++i) {
    Rng rng(1, 0, uint64_t(i));
    light.push_back({rng.uniform(), rng.uniform(), rng.uniform()});
  }
  return light;
}

TEST(LightHarmonics, AreOrthonormalOverTheSphere) {
  constexpr int kRows = 48;
  HarmonicMatrix product{};
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < 2 * kRows; ++column) {
      const Harmonics h = harmonics(env_direction(float(column) + 0.5f, float(row) + 0.5f, 2 * kRows, kRows));
      for (size_t i = 0; i < kHarmonics; ++i)
        for (size_t j = 0; j < kHarmonics; ++j)
          product[i][j] += h[i] * h[j] * env_solid_angle(row, 2 * kRows, kRows);
    }
  for (size_t i = 0; i < kHarmonics; ++i)
    for (size_t j = 0; j < kHarmonics; ++j) EXPECT_NEAR(product[i][j], i == j, 0.01f) << i << ' ' << j;
}

TEST(LightHarmonics, TurnAsTheirDirectionsDo) {
  const Mat3f turn = about_axis(normalize(Vec3f{1, -2, 0.5f}), 1.3f);
  const HarmonicMatrix m = turned_harmonics(turn);
  for (uint64_t i = 0; i < 20; ++i) {
    Rng rng(2, 0, i);
    const Vec3f d = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
    const Harmonics got = m * harmonics(d), want = harmonics(turn * d);
    for (size_t j = 0; j < kHarmonics; ++j) EXPECT_NEAR(got[j], want[j], 0.02f);
  }
}

TEST(LightHarmonics, TheAdjointIsOne) {
  const int height = 12;
  const LightHarmonics map(height);
  const std::vector<Vec3f> light = some_light(height);
  HarmonicLight weights;
  for (size_t j = 0; j < kHarmonics; ++j) weights[j] = some_light(4)[j];
  std::vector<Vec3f> back(light.size(), Vec3f{0, 0, 0});
  map.add_transposed(weights, back);
  const HarmonicLight forth = map.of(light);
  double a = 0, b = 0;
  for (size_t j = 0; j < kHarmonics; ++j) a += double(dot(weights[j], forth[j]));
  for (size_t i = 0; i < light.size(); ++i) b += double(dot(light[i], back[i]));
  EXPECT_NEAR(a, b, 1e-3 * std::abs(a));
}

}  // namespace
}  // namespace cei3d
