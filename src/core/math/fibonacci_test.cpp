// SPDX-License-Identifier: Apache-2.0
#include "core/math/fibonacci.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

// Means over the sphere that are known: of every coordinate 0, of the products of two coordinates 1/3 or 0.
TEST(Fibonacci, DirectionsAreUnitAndUniform) {
  constexpr int kCount = 500;
  Vec3f sum{0, 0, 0}, squares{0, 0, 0}, products{0, 0, 0};
  for (int i = 0; i < kCount; ++i) {
    const Vec3f d = fibonacci_direction(i, kCount);
    EXPECT_NEAR(length(d), 1, 1e-6);
    sum += d / float(kCount);
    squares += d * d / float(kCount);
    products += Vec3f{d.x * d.y, d.y * d.z, d.z * d.x} / float(kCount);
  }
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(sum[c], 0, 2e-3);
    EXPECT_NEAR(squares[c], 1.0 / 3, 2e-3);
    EXPECT_NEAR(products[c], 0, 2e-3);
  }
}

}  // namespace
}  // namespace cei3d
