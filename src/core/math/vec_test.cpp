// SPDX-License-Identifier: Apache-2.0
#include "core/math/vec.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"
#include "core/math/trilinear.h"

namespace cei3d {
namespace {

Mat3<double> random_matrix(uint64_t seed) {
  Rng rng(seed, 0, 0);
  Mat3<double> m;
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c) m.row[i][c] = rng.uniform() * 2 - 1 + (i == c ? 2 : 0);
  return m;
}

Vec3d random_vector(uint64_t seed) {
  Rng rng(seed, 1, 0);
  return {rng.uniform() * 2 - 1, rng.uniform() * 2 - 1, rng.uniform() * 2 - 1};
}

TEST(Mat3, InverseTakesBackWhatTheMatrixDoes) {
  for (uint64_t i = 0; i < 100; ++i) {
    const Mat3<double> m = random_matrix(i);
    const Vec3d v = random_vector(i);
    EXPECT_NEAR(length(inverse(m) * (m * v) - v), 0, 1e-13);
    EXPECT_NEAR(length(m * (inverse(m) * v) - v), 0, 1e-13);
  }
}

TEST(Mat3, DeterminantsMultiply) {
  for (uint64_t i = 0; i < 100; ++i) {
    const Mat3<double> a = random_matrix(i), b = random_matrix(i + 1000);
    EXPECT_NEAR(determinant(a * b), determinant(a) * determinant(b), 1e-11);
  }
  EXPECT_EQ(determinant(Mat3d{{{2, 0, 0}, {0, 0, 3}, {0, 4, 0}}}), -24);
}

TEST(Mat3, InverseTransposeKeepsNormalsNormalToWhatTheMatrixMoves) {
  for (uint64_t i = 0; i < 100; ++i) {
    const Mat3<double> m = random_matrix(i);
    const Vec3d u = random_vector(i), v = random_vector(i + 1000);
    const Vec3d n = inverse_transpose(m) * cross(u, v);
    EXPECT_NEAR(dot(n, m * u), 0, 1e-13);
    EXPECT_NEAR(dot(n, m * v), 0, 1e-13);
  }
}

// Interpolation between samples of a function that is linear along each axis is that function.
TEST(Trilinear, ReproducesWhatIsLinearAlongEachAxis) {
  constexpr int kCells = 8;
  const auto f = [](double x, double y, double z) {
    return 1 + 2 * x - y + 3 * z + x * y - 2 * y * z + x * y * z;
  };
  const auto center = [](int i) { return 2 * (i + 0.5) / kCells - 1; };
  const auto cell = [&](int x, int y, int z) { return float(f(center(x), center(y), center(z))); };
  for (uint64_t i = 0; i < 200; ++i) {
    const Vec3d p = random_vector(i) * 0.8;  // between the outermost centers, at +-0.875
    EXPECT_NEAR(trilinear(to_float(p), kCells, cell), f(p.x, p.y, p.z), 2e-5);
  }
}

TEST(Trilinear, BeyondTheOutermostCentersIsAsThere) {
  const auto cell = [](int x, int y, int z) { return float(x + 10 * y + 100 * z); };
  EXPECT_NEAR(trilinear({-1, -1, -1}, 4, cell), 0, 1e-6);
  EXPECT_NEAR(trilinear({-7, -1, -1}, 4, cell), 0, 1e-6);
  EXPECT_NEAR(trilinear({1, 1, 1}, 4, cell), 333, 0.12);  // it stays a thousandth of a cell inside
  EXPECT_EQ(trilinear({1, 1, 1}, 4, cell), trilinear({9, 1, 2}, 4, cell));
}

}  // namespace
}  // namespace cei3d
