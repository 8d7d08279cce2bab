// SPDX-License-Identifier: Apache-2.0
#include "core/math/color.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

TEST(Color, TheSlopeOfTheDisplayCurveEqualsItsDifferences) {
  for (const float c : {0.001f, 0.01f, 0.1f, 0.5f, 0.9f}) {
    const float h = 0.01f * c;
    const double slope = double(srgb_from_linear(c + h) - srgb_from_linear(c - h)) / (2 * double(h));
    EXPECT_NEAR(srgb_slope(c), slope, 0.005 * slope) << c;
  }
}

TEST(Color, LinearAndDisplayAreInverse) {
  for (const float c : {0.0f, 0.002f, 0.0031308f, 0.2f, 1.0f})
    EXPECT_NEAR(linear_from_srgb(srgb_from_linear(c)), c, 1e-6f + 1e-5f * c);
}

}  // namespace
}  // namespace cei3d
