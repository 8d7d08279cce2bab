// SPDX-License-Identifier: Apache-2.0
#include "core/math/quick_angles.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

TEST(QuickAngles, AreThoseOfTheStandardLibrary) {
  for (int i = -1000; i <= 1000; ++i) {
    const float x = float(i) / 1000;
    EXPECT_NEAR(quick_acos(x), std::acos(x), 7e-5f) << x;
    const float turn = x * 3.14159f;
    for (const float length : {1e-3f, 1.0f, 30.0f})
      EXPECT_NEAR(quick_atan2(length * std::sin(turn), length * std::cos(turn)), turn, 2e-5f) << turn;
  }
  EXPECT_EQ(quick_atan2(0, 0), 0);
}

}  // namespace
}  // namespace cei3d
