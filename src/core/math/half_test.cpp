// SPDX-License-Identifier: Apache-2.0
#include "core/math/half.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace cei3d {
namespace {

// By the definition: sign, exponent, significand.
double value_of(uint16_t h) {
  const int exponent = h >> 10 & 31, significand = h & 1023;
  const double sign = h & 0x8000 ? -1 : 1;
  if (exponent == 31) return significand ? NAN : sign * INFINITY;
  return sign * (exponent ? std::ldexp(1024 + significand, exponent - 25) : std::ldexp(significand, -24));
}

TEST(Half, AllOfThemAreWhatTheStandardSays) {
  for (uint32_t h = 0; h < 0x10000; ++h) {
    const double value = value_of(uint16_t(h));
    if (std::isnan(value)) {
      EXPECT_TRUE(std::isnan(float_from_half(uint16_t(h))));
      EXPECT_TRUE(std::isnan(float_from_half(half_from_float(float(value)))));
      continue;
    }
    ASSERT_EQ(double(float_from_half(uint16_t(h))), value) << h;
    ASSERT_EQ(half_from_float(float(value)), h);
  }
}

TEST(Half, RoundsToTheNearest) {
  for (uint16_t h = 0; h < 0x7bff; ++h) {
    const auto low = float(value_of(h)), high = float(value_of(uint16_t(h + 1)));
    const float middle = 0.5f * (low + high);  // exact: it has one bit more
    const uint16_t even = h % 2 ? uint16_t(h + 1) : h;
    ASSERT_EQ(half_from_float(middle), even);
    ASSERT_EQ(half_from_float(std::nextafter(middle, low)), h);
    ASSERT_EQ(half_from_float(std::nextafter(middle, high)), h + 1);
    ASSERT_EQ(half_from_float(-std::nextafter(middle, low)), h | 0x8000);
  }
  EXPECT_EQ(half_from_float(65519.99f), 0x7bff);
  EXPECT_EQ(half_from_float(65520), 0x7c00);
  EXPECT_EQ(half_from_float(std::numeric_limits<float>::infinity()), 0x7c00);
  EXPECT_EQ(half_from_float(1e-10f), 0);
}

}  // namespace
}  // namespace cei3d
