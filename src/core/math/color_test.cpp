// SPDX-License-Identifier: Apache-2.0
#include "core/math/color.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/dual.h"

namespace cei3d {
namespace {

TEST(Color, TheSlopeOfTheDisplayCurveEqualsItsDifferences) {
  for (const float c : {0.001f, 0.01f, 0.1f, 0.5f, 0.9f}) {
    const float h = 0.01f * c;
    const double slope = double(srgb_from_linear(c + h) - srgb_from_linear(c - h)) / (2 * double(h));
    EXPECT_NEAR(srgb_derivative(c), slope, 0.005 * slope) << c;
  }
}

TEST(Color, TheSlopeOfTheDisplayCurveEqualsDualNumbers) {
  using D = Dual<double>;
  for (const double c : {0.001, 0.01, 0.1, 0.5, 0.9, 2.0}) {
    const double slope = srgb_from_linear(D(c, 1)).derivative;
    EXPECT_NEAR(srgb_derivative(c), slope, 1e-6 * slope) << c;
  }
}

TEST(Color, LinearAndDisplayAreInverse) {
  for (const float c : {0.0f, 0.002f, 0.0031308f, 0.2f, 1.0f})
    EXPECT_NEAR(linear_from_srgb(srgb_from_linear(c)), c, 1e-6f + 1e-5f * c);
}

TEST(Color, OklabOfGraysAndPrimariesIsThePublishedOne) {  // [Ottosson 2020]
  for (const float y : {0.0f, 0.18f, 1.0f}) {
    const Vec3f lab = oklab_from_linear({y, y, y});
    EXPECT_NEAR(lab.x, std::cbrt(y), 1e-5);
    EXPECT_NEAR(lab.y, 0, 1e-4);
    EXPECT_NEAR(lab.z, 0, 1e-4);
  }
  const auto expect = [](Vec3f linear, Vec3f lab) {
    EXPECT_NEAR(length(oklab_from_linear(linear) - lab), 0, 1e-3);
  };
  expect({1, 0, 0}, {0.6280f, 0.2249f, 0.1258f});
  expect({0, 1, 0}, {0.8664f, -0.2339f, 0.1795f});
  expect({0, 0, 1}, {0.4520f, -0.0324f, -0.3115f});
}

}  // namespace
}  // namespace cei3d
