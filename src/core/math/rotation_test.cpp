// SPDX-License-Identifier: Apache-2.0
#include "core/math/rotation.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

void expect_near(Vec3f a, Vec3f b) { EXPECT_LT(length(a - b), 1e-5f); }

TEST(Rotation, TurnsCounterClockwiseAboutItsAxis) {
  expect_near(about_axis({0, 0, 1}, kPi / 2) * Vec3f{1, 0, 0}, {0, 1, 0});
  const Vec3f axis = normalize(Vec3f{1, 2, 3});
  expect_near(about_axis(axis, 0.7f) * axis, axis);
  expect_near(about_axis(axis, 0.7f) * (about_axis(axis, -0.7f) * Vec3f{1, 0, 2}), {1, 0, 2});
}

TEST(Rotation, TakesOneVectorToAnother) {
  const Vec3f a = normalize(Vec3f{1, -2, 0.5f}), b = normalize(Vec3f{0.3f, 0.4f, -1});
  for (const Vec3f to : {a, b, -a}) expect_near(turning(a, to) * a, to);
}

// A camera that goes round an object and is tilted: the angle is how far it went, whatever the tilt.
TEST(Rotation, AngleAboutAnAxisIsFreeOfTilts) {
  const Vec3f up{0, 0, 1};
  for (const float turn : {-3.0f, -1.0f, 0.0f, 0.4f, 2.0f, 3.1f})
    for (const float tilt : {-0.6f, 0.0f, 0.9f})
      EXPECT_NEAR(angle_about(up, about_axis(up, turn) * about_axis({1, 0, 0}, tilt)), turn, 1e-5f);
  EXPECT_NEAR(std::abs(angle_about(up, about_axis(up, kPi))), kPi, 1e-5f);
}

}  // namespace
}  // namespace cei3d
