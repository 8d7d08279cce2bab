// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/find_rings.h"

#include <gtest/gtest.h>

#include "core/math/fibonacci.h"
#include "core/math/rigid_motion.h"
#include "core/math/rng.h"
#include "engine/reconstruct/appearance/find_light_frame.h"

namespace cei3d {
namespace {

// In a room whose up is +Z, an object on a turntable before a tripod to its -Y.
struct Shot {
  Mat3d room_from_object;
  double elevation;  // of the camera, radians
};

// lying: how the object lies on the turntable.
void add_ring(std::vector<Shot>& shots, const Mat3d& lying, double elevation, int count) {
  for (int k = 0; k < count; ++k) shots.push_back({rotation_of({0, 0, 0.24 * k}) * lying, elevation});
}

std::vector<Shot> laid_down_twice() {
  std::vector<Shot> shots;
  const Mat3d flipped = rotation_of({2.1, 0.4, -0.3});
  add_ring(shots, Mat3d::identity(), 0.45, 20);
  add_ring(shots, Mat3d::identity(), 0.60, 14);
  add_ring(shots, flipped, 0.63, 25);
  return shots;
}

// A tripod that is a little askew, and poses that are a little wrong.
std::vector<Camera> cameras_of(const std::vector<Shot>& shots) {
  constexpr double kAskew = 0.04, kNoise = 0.003;
  Rng rng(1, 0, 0);
  std::vector<Camera> out;
  for (const Shot& s : shots) {
    const Vec3d forward{0, std::cos(s.elevation), -std::sin(s.elevation)};
    Camera camera;
    camera.world_from_cam =
        rotation_of({kNoise * rng.normal(), kNoise * rng.normal(), kNoise * rng.normal()}) *
        transpose(s.room_from_object) * rotation_of(forward * kAskew) * upright_rotation(forward, {0, 0, 1});
    out.push_back(camera);
  }
  return out;
}

TEST(FindRings, OneForEachWayToLieAndHeightOfTheCamera) {
  const std::vector<CameraRing> rings = find_rings(cameras_of(laid_down_twice()));
  ASSERT_EQ(rings.size(), 3u);
  const Vec3f flipped = to_float(transpose(rotation_of({2.1, 0.4, -0.3})) * Vec3d{0, 0, 1});
  int upright = 0;
  for (const CameraRing& ring : rings) {
    upright += ring.axis.z > std::cos(0.01f);
    EXPECT_GT(std::max(ring.axis.z, dot(ring.axis, flipped)), std::cos(0.01f));
  }
  EXPECT_EQ(upright, 2);
}

// What stands still in the room must stand still in the frame of the light, whichever way the object lies.
TEST(FindRings, LampsStandStillInAllOfThem) {
  const std::vector<Shot> shots = laid_down_twice();
  const std::vector<Camera> cameras = cameras_of(shots);
  const LightFrame frame = light_frame(LightMotion::turntable, cameras, {0, 0, 1});
  for (const Vec3d lamp : {Vec3d{1, 0, 0}, Vec3d{0, 0, 1}})
    for (size_t i = 0; i < shots.size(); ++i) {
      const Vec3f on_object = to_float(transpose(shots[i].room_from_object) * lamp),
                  on_first = to_float(transpose(shots[0].room_from_object) * lamp);
      EXPECT_GT(dot(frame.room_from_object(cameras[i].world_from_cam) * on_object, on_first), std::cos(0.03f))
          << i;
    }
}

// A held-out photograph is of the ring whose tilt it has.
TEST(FindRings, HoldForPhotographsThatWereNotThere) {
  const std::vector<Shot> shots = laid_down_twice();
  std::vector<Shot> most;
  for (size_t i = 0; i < shots.size(); ++i)
    if (i % 8 != 3) most.push_back(shots[i]);
  const LightFrame frame = light_frame(LightMotion::turntable, cameras_of(most), {0, 0, 1});
  const std::vector<Camera> all = cameras_of(shots);
  const Vec3d lamp{0.6, 0, 0.8};
  for (size_t i = 3; i < shots.size(); i += 8)
    EXPECT_GT(dot(frame.room_from_object(all[i].world_from_cam) *
                      to_float(transpose(shots[i].room_from_object) * lamp),
                  to_float(transpose(shots[0].room_from_object) * lamp)),
              std::cos(0.03f))
        << i;
}

TEST(FindRings, NoneWhereTheCameraNeverMoved) {
  std::vector<Shot> shots;
  add_ring(shots, Mat3d::identity(), 0.45, 26);
  EXPECT_TRUE(find_rings(cameras_of(shots)).empty());
}

TEST(FindRings, NoneAllAround) {
  std::vector<Camera> cameras(80);
  for (int i = 0; i < 80; ++i)
    cameras[size_t(i)].world_from_cam = upright_rotation(to_double(fibonacci_direction(i, 80)), {0, 0, 1});
  EXPECT_TRUE(find_rings(cameras).empty());
  EXPECT_TRUE(find_rings({}).empty());
}

}  // namespace
}  // namespace cei3d
