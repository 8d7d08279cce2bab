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

// Its descent would be shorter than the estimate before it, or hardly a descent.
TEST(PolishRound, ARoundThatIsNotWorthItsEstimateLeavesItsTimeToThoseBefore) {
  EXPECT_DOUBLE_EQ(descent_seconds(80, 2, 26, 90), 27);
  EXPECT_DOUBLE_EQ(descent_seconds(80, 2, 28, 90), 80);
  EXPECT_DOUBLE_EQ(descent_seconds(80, 3, 28, 90), 80);
  EXPECT_DOUBLE_EQ(descent_seconds(29, 2, 1, 90), 29);
  EXPECT_DOUBLE_EQ(descent_seconds(32, 2, 1, 90), 15.5);
}

// What the plan has for later stages stays theirs, and they get what a round leaves that is left out.
TEST(PolishRound, NoneTakesMoreThanWhatWasPlanned) {
  EXPECT_DOUBLE_EQ(descent_seconds(250, 2, 10, 90), 90);
  EXPECT_DOUBLE_EQ(descent_seconds(250, 2, 90, 90), 90);
}

// An estimate that takes longer than a whole descent does not forbid one.
TEST(PolishRound, AWholeDescentIsWorthALook) {
  EXPECT_TRUE(worth_a_look(90, 140, 90));
  EXPECT_FALSE(worth_a_look(89, 140, 90));
}

// What is left after a round is worth the look of a second one exactly where the first counted on it.
TEST(PolishRound, TheSecondRoundDecidesAsTheFirstDid) {
  for (const double look : {1.0, 20.0, 60.0, 100.0})
    for (double left = 5; left < 400; left += 7) {
      const double rest = left - descent_seconds(left, 2, look, 90) - look;
      EXPECT_EQ(worth_a_look(rest, look, 90), worth_a_look((left - look) / 2, look, 90))
          << left << " " << look;
    }
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
