// SPDX-License-Identifier: Apache-2.0
#include "model/light/light_turns.h"

#include <gtest/gtest.h>

#include "core/math/rotation.h"
#include "model/light/sg_mixture.h"

namespace cei3d {
namespace {

Mat3d to_double(const Mat3f& m) {
  Mat3d out;
  for (int i = 0; i < 3; ++i) out.row[i] = cei3d::to_double(m.row[i]);
  return out;
}

// The rotation of a camera that looks from an azimuth and a height at the origin.
Mat3f camera_at(float azimuth, float height) {
  const Vec3f z = normalize(Vec3f{-std::cos(azimuth), -std::sin(azimuth), -height}),
              x = normalize(cross(z, Vec3f{0, 0, 1})), y = cross(z, x);
  return transpose(Mat3f{{x, y, z}});
}

// A lamp that stands still in the room, seen from an object that turns by -azimuth.
TEST(LightFrame, OnATurntableALampStandsWhereTheObjectsTurnPutsIt) {
  const Vec3f lamp = normalize(Vec3f{0.3f, -0.5f, 0.8f});
  LightFrame frame{LightMotion::turntable, {0, 0, 1}, camera_at(0.4f, 0.2f)};
  for (const float azimuth : {0.4f, 1.0f, 3.0f, 5.5f}) {
    const Vec3f on_object = about_axis({0, 0, 1}, azimuth - 0.4f) * lamp;  // the light has gone round as far
    const Mat3f room = frame.room_from_object(to_double(camera_at(azimuth, 0.9f)));
    EXPECT_LT(length(room * on_object - lamp), 1e-5f) << azimuth;
  }
}

TEST(LightFrame, AFlashStaysAtTheCamera) {
  const Mat3f first = camera_at(0.4f, 0.2f), other = camera_at(2.0f, 0.7f);
  const LightFrame frame{LightMotion::camera, {0, 0, 1}, first};
  const Vec3f flash{0.1f, 0.2f, -1};  // in the camera's axes
  EXPECT_LT(length(frame.room_from_object(to_double(other)) * (other * flash) - first * flash), 1e-5f);
}

TEST(LightTurns, EveryViewHasABinNearby) {
  std::vector<Mat3f> rotations;
  for (int k = 0; k < 200; ++k) rotations.push_back(about_axis({0, 0, 1}, 0.0314f * float(k)));
  const LightTurns turns = light_turns(rotations);
  EXPECT_LE(turns.bins.size(), kMaxLightBins);
  for (size_t v = 0; v < rotations.size(); ++v) {
    const Vec3f x{1, 0, 0};
    EXPECT_GT(dot(turns.bins[turns.bin[v]] * x, rotations[v] * x), std::cos(0.4f));
  }
  EXPECT_EQ(light_turns(std::vector<Mat3f>(9, Mat3f::identity())).bins.size(), 1u);
}

}  // namespace
}  // namespace cei3d
