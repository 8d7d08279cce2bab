// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/lobe_blur.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/reflection.h"
#include "core/math/rng.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

constexpr int kHeight = 12, kWidth = 2 * kHeight;

std::vector<Vec3f> random_light(uint64_t seed) {
  std::vector<Vec3f> light(size_t(kHeight) * kWidth);
  for (size_t i = 0; i < light.size(); ++i) {
    Rng rng(seed, 0, i);
    light[i] = {rng.uniform(), rng.uniform(), rng.uniform()};
  }
  return light;
}

double product(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += double(dot(a[i], b[i]));
  return sum;
}

// The mean of the light over the lobe around a cell's center, by brute force.
Vec3f mean_over_lobe(const std::vector<Vec3f>& light, int row, int column, float roughness) {
  constexpr int kFine = 9;  // samples along an axis of a cell
  const ReflectionLobe<float> lobe = reflection_lobe(roughness);
  const Vec3f axis = env_direction(float(column) + 0.5f, float(row) + 0.5f, kWidth, kHeight);
  Vec3d sum{0, 0, 0};
  double total = 0;
  for (int y = 0; y < kFine * kHeight; ++y)
    for (int x = 0; x < kFine * kWidth; ++x) {
      const Vec3f d = env_direction(float(x) + 0.5f, float(y) + 0.5f, kFine * kWidth, kFine * kHeight);
      double weight = 0;
      for (int j = 0; j < kReflectionLobes; ++j)
        weight += lobe.weight[j] * std::exp(lobe.lambda[j] * (dot(axis, d) - 1));
      weight *= env_solid_angle(y, kFine * kWidth, kFine * kHeight);
      sum += to_double(light[size_t(y / kFine) * kWidth + x / kFine]) * weight;
      total += weight;
    }
  return to_float(sum / total);
}

TEST(LobeBlur, IsTheMeanOverTheReflectionLobe) {
  const std::vector<Vec3f> light = random_light(1);
  for (const float roughness : {0.25f, 0.6f}) {
    std::vector<Vec3f> blurred;
    LobeBlur(roughness, kHeight).apply(light, blurred);
    for (int row = 0; row < kHeight; ++row)
      for (const int column : {0, 7, kWidth - 1}) {
        const Vec3f want = mean_over_lobe(light, row, column, roughness);
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(blurred[size_t(row) * kWidth + column][c], want[c], 0.02f) << roughness << ' ' << row;
      }
  }
}

TEST(LobeBlur, TheTransposedIsTheAdjoint) {
  const LobeBlur blur(0.4f, kHeight);
  const std::vector<Vec3f> x = random_light(2), y = random_light(3);
  std::vector<Vec3f> kx, ky;
  blur.apply(x, kx);
  blur.apply_transposed(y, ky);
  EXPECT_NEAR(product(kx, y), product(x, ky), 1e-4 * product(x, ky));
}

// Its columns, one by one, tell the entries.
TEST(LobeBlur, TheSquaredOneHasTheSquaresOfTheEntries) {
  const LobeBlur blur(0.4f, kHeight);
  const std::vector<Vec3f> y = random_light(4);
  std::vector<Vec3f> got;
  blur.apply_squared_transposed(y, got);
  for (const size_t cell : {size_t(3), size_t(100), size_t(200)}) {
    std::vector<Vec3f> unit(got.size(), Vec3f{0, 0, 0}), column;
    unit[cell] = {1, 1, 1};
    blur.apply(unit, column);
    double want = 0;
    for (size_t i = 0; i < column.size(); ++i) want += double(column[i].x) * column[i].x * y[i].x;
    EXPECT_NEAR(got[cell].x, want, 1e-4 * want + 1e-6);
  }
}

TEST(LobeBlur, UniformLightStaysAsItIs) {
  std::vector<Vec3f> light(size_t(kHeight) * kWidth, Vec3f{1, 2, 3}), blurred;
  LobeBlur(0.3f, kHeight).apply(light, blurred);
  for (const Vec3f& v : blurred) EXPECT_NEAR(v.z, 3, 1e-4);
}

}  // namespace
}  // namespace cei3d
