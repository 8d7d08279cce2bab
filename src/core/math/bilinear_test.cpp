// SPDX-License-Identifier: Apache-2.0
#include "core/math/bilinear.h"

#include <gtest/gtest.h>

#include "core/math/dual.h"

namespace cei3d {
namespace {

// It is the one function a + x b + y c + x y d through four corners.
TEST(Bilinear, ContinuesWhatIsBilinear) {
  const auto f = [](double x, double y) { return 2 - 0.5 * x + 3 * y + 1.25 * x * y; };
  const SquareCorners<double> corners{f(0, 0), f(1, 0), f(0, 1), f(1, 1)};
  for (const double x : {0.0, 0.3, 1.0})
    for (const double y : {0.0, 0.8, 1.0}) EXPECT_NEAR(bilinear(corners, x, y), f(x, y), 1e-14);
}

TEST(Bilinear, DerivativesAreThoseOfDualNumbers) {
  const SquareCorners<double> v{0.2, -1.5, 3, 0.7};
  const double x = 0.3, y = 0.8;
  using D = Dual<double>;
  const SquareCorners<D> dual{D(v.a), D(v.b), D(v.c), D(v.d)};
  EXPECT_NEAR(bilinear_d_x(v, y), bilinear(dual, D{x, 1}, D(y)).derivative, 1e-14);
  EXPECT_NEAR(bilinear_d_y(v, x), bilinear(dual, D(x), D{y, 1}).derivative, 1e-14);
}

}  // namespace
}  // namespace cei3d
