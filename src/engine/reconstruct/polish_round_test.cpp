// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/polish_round.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

TEST(PolishRound, RoundsShareWhatTheirEstimatesLeave) {
  const double first = descent_seconds(200, 2, 40, 10);
  EXPECT_DOUBLE_EQ(first, 80);
  EXPECT_DOUBLE_EQ(descent_seconds(200 - first - 40, 1, 40, 10), 80);  // after the second estimate
}

TEST(PolishRound, ARoundThatWouldBeTooShortLeavesItsTimeToThoseBefore) {
  EXPECT_DOUBLE_EQ(descent_seconds(150, 2, 129, 11), 150);
  EXPECT_DOUBLE_EQ(descent_seconds(150, 2, 127, 11), 11.5);
  EXPECT_DOUBLE_EQ(descent_seconds(150, 3, 129, 11), 150);
}

}  // namespace
}  // namespace cei3d
