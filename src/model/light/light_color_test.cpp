// SPDX-License-Identifier: Apache-2.0
#include "model/light/light_color.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cei3d {
namespace {

constexpr Vec3f kOrange{1, 0.7f, 0.45f};

LightScale errors_of(double each) {
  return {{1, 1, 1}, {{{each * each, 0, 0}, {0, each * each, 0}, {0, 0, each * each}}}};
}

Vec3f believed(double error, const LightColorPrior& prior) {
  return kOrange * weigh_light_color(errors_of(error), kOrange, prior).factor;
}

TEST(LightColor, HighlightsThatAreSeenWellOverruleThePrior) {
  const Vec3f color = believed(0.02, {});
  EXPECT_NEAR(color.x / color.y, 1 / 0.7f, 0.15f);
  EXPECT_NEAR(color.z / color.y, 0.45f / 0.7f, 0.06f);
}

TEST(LightColor, WithoutHighlightsTheLightIsNearlyWhiteAndAsBright) {
  const Vec3f color = believed(3, {});
  EXPECT_NEAR(color.x / color.y, 1, 0.08f);
  EXPECT_NEAR(color.z / color.y, 1, 0.08f);
  // All channels as uncertain: their geometric mean stays.
  EXPECT_NEAR(color.x * color.y * color.z, kOrange.x * kOrange.y * kOrange.z, 0.01f);
}

// The channel that is known better stays.
TEST(LightColor, TheUncertainChannelMoves) {
  LightScale evidence = errors_of(0.05);
  evidence.covariance.row[2].z = 4;
  const Vec3f factor = weigh_light_color(evidence, kOrange, {}).factor;
  EXPECT_NEAR(factor.y, 1, 0.1f);
  EXPECT_GT(factor.z, 1.3f);
}

TEST(LightColor, KnownAndFreeColorsAreTakenAsTheyAre) {
  const Vec3f known = believed(0.1, {LightColorPrior::Kind::known, {2, 2, 1}});
  EXPECT_NEAR(known.x / known.y, 1, 0.01f);
  EXPECT_NEAR(known.z / known.y, 0.5f, 0.01f);
  const Vec3f free = believed(3, {LightColorPrior::Kind::free, {1, 1, 1}});
  EXPECT_EQ(free.z, kOrange.z);
}

// What is believed makes the color more certain, not the brightness.
TEST(LightColor, ThePriorNarrowsRatiosOnly) {
  const LightCovariance c = weigh_light_color(errors_of(1), kOrange, {}).covariance;
  const double blue_over_green = c.row[2].z + c.row[1].y - 2 * c.row[1].z,
               brightness =
                   (c.row[0].x + c.row[1].y + c.row[2].z + 2 * (c.row[0].y + c.row[0].z + c.row[1].z)) / 9;
  EXPECT_LT(std::sqrt(blue_over_green), 0.3);  // the prior's own
  EXPECT_NEAR(brightness, 1 / (3 * (1 / 1.0 + 1 / (0.7 * 0.7))), 0.02);
}

TEST(LightColor, WhatPhotographsSayIsFollowed) {
  LightScale evidence = errors_of(0.02);
  evidence.factor = {1 / kOrange.x, 1 / kOrange.y, 1 / kOrange.z};  // the light is white after all
  const Vec3f color = kOrange * weigh_light_color(evidence, kOrange, {}).factor;
  EXPECT_LT(length(color - Vec3f{1, 1, 1}), 0.02f);
}

TEST(LightColor, WordsAreReadAndWritten) {
  for (const std::string text : {"free", "near-white", "1,0.7,0.45"})
    EXPECT_EQ(light_color_text(*light_color_from(text)), text);
  for (const std::string text : {"", "white", "1,2", "1,2,3,4", "0,1,1", "-1,1,1", "nan,1,1", "1,1,1x"})
    EXPECT_FALSE(light_color_from(text)) << text;
}

}  // namespace
}  // namespace cei3d
