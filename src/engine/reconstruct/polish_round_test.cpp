// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/polish_round.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

TEST(PolishRound, RoundsShareWhatTheirEstimatesLeave) {
  const double first = descent_seconds(200, 2, 40, 90);
  EXPECT_DOUBLE_EQ(first, 80);
  EXPECT_DOUBLE_EQ(descent_seconds(200 - first - 40, 1, 40, 90), 80);  // after the second estimate
}

TEST(PolishRound, ARoundThatWouldBeTooShortLeavesItsTimeToThoseBefore) {
  EXPECT_DOUBLE_EQ(descent_seconds(150, 2, 131, 90), 150);
  EXPECT_DOUBLE_EQ(descent_seconds(150, 2, 120, 90), 15);
  EXPECT_DOUBLE_EQ(descent_seconds(150, 3, 131, 90), 150);
}

// What the plan has for later stages stays theirs.
TEST(PolishRound, NoneTakesMoreThanWhatWasPlanned) {
  EXPECT_DOUBLE_EQ(descent_seconds(250, 2, 10, 90), 90);
  EXPECT_DOUBLE_EQ(descent_seconds(250, 2, 240, 90), 180);
}

TEST(PolishRound, LeavesLightAndAppearanceWhatABriefEstimateSaysThatTheyNeed) {
  Plan plan;
  plan.appearance = 100;
  plan.effort = Effort::full;
  EXPECT_EQ(seconds_lent(plan, 40, 300), 0);
  EXPECT_DOUBLE_EQ(seconds_lent(plan, 80, 300), 60);
  EXPECT_DOUBLE_EQ(seconds_lent(plan, 300, 300), 150);  // half of what is left
  EXPECT_EQ(seconds_lent(plan, 300, -5), 0);
  plan.effort = Effort::brief;
  EXPECT_EQ(seconds_lent(plan, 80, 300), 0);
  EXPECT_DOUBLE_EQ(seconds_lent(plan, 120, 300), 20);
}

}  // namespace
}  // namespace cei3d
