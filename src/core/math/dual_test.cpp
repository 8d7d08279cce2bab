// SPDX-License-Identifier: Apache-2.0
#include "core/math/dual.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

using D = Dual<double>;
using D2 = Dual<D>;

TEST(Dual, FirstDerivativesAreThoseOfTheTextbook) {
  const D x(0.7, 1.0);
  EXPECT_NEAR(derivative_of(exp(x) * sin(x)), std::exp(0.7) * (std::sin(0.7) + std::cos(0.7)), 1e-15);
  EXPECT_NEAR(derivative_of(sqrt(x) / log(x + D(1.0))),
              0.5 / std::sqrt(0.7) / std::log(1.7) - std::sqrt(0.7) / (1.7 * std::log(1.7) * std::log(1.7)),
              1e-14);
  EXPECT_NEAR(derivative_of(pow(x, 2.5f)), 2.5 * std::pow(0.7, 1.5), 1e-14);
  EXPECT_DOUBLE_EQ(derivative_of(abs(D(-2.0, 1.0))), -1);
  EXPECT_DOUBLE_EQ(derivative_of(max(x, D(1.0))), 0);
  EXPECT_DOUBLE_EQ(derivative_of(floor(x)), 0);
}

TEST(Dual, NestsToSecondDerivatives) {
  const D2 x(D(0.3, 1.0), D(1.0, 0.0));
  const D2 y = exp(x * x) * cos(x);
  const double e = std::exp(0.09), c = std::cos(0.3), s = std::sin(0.3);
  EXPECT_NEAR(y.derivative.derivative, e * ((2 + 4 * 0.09) * c - 4 * 0.3 * s - c), 1e-14);
}

}  // namespace
}  // namespace cei3d
