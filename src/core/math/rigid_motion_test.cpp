// SPDX-License-Identifier: Apache-2.0
#include "core/math/rigid_motion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"

namespace cei3d {
namespace {

TEST(RigidMotion, BetweenTwoCamerasIsTheOneThatMovedThem) {
  Camera camera;
  camera.world_from_cam = rotation_of({0.3, -1.2, 0.5});
  camera.center = {1, -3, 2};
  for (const Vec3d turn : {Vec3d{0, 0, 0}, Vec3d{1e-9, 0, 0}, Vec3d{0.02, -0.01, 0.03}, Vec3d{-1, 2, 0.5}}) {
    const Vec3d shift{0.1, 0.2, -0.3};
    const RigidMotion m = motion_between(camera, moved(camera, {turn, shift}));
    EXPECT_LT(length(m.turn - turn), 1e-12);
    EXPECT_LT(length(m.shift - shift), 1e-12);
  }
}

// About the origin, and so that what it turns stays as large as it is.
TEST(RigidMotion, TurnsAboutTheOriginBeforeItShifts) {
  Camera camera;
  camera.center = {1, 0, 0};
  const Camera turned = moved(camera, {{0, 0, M_PI / 2}, {0, 0, 5}});
  EXPECT_LT(length(turned.center - Vec3d{0, 1, 5}), 1e-12);
  EXPECT_LT(length(turned.world_from_cam * Vec3d{1, 0, 0} - Vec3d{0, 1, 0}), 1e-12);
}

Camera skewed_camera() {
  Camera camera;
  camera.fx = 90, camera.fy = 110, camera.cx = 48, camera.cy = 40, camera.skew = 0.7;
  camera.world_from_cam = rotation_of({0.3, -1.2, 0.5});
  camera.center = camera.world_from_cam * Vec3d{0.2, -0.1, -3};
  return camera;
}

TEST(MotionGrad, AreThoseOfFiniteDifferences) {
  const Camera camera = skewed_camera();
  for (uint64_t i = 0; i < 20; ++i) {
    Rng rng(4, 0, i);
    const Vec3d point = 0.3 * Vec3d{rng.normal(), rng.normal(), rng.normal()};
    const MotionGrad grad = motion_grad(camera, point);
    constexpr double kStep = 1e-6;
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d d{0, 0, 0};
      d[axis] = kStep;
      const Vec3d turned = moved(camera, {d, {0, 0, 0}}).project(point) -
                           moved(camera, {-d, {0, 0, 0}}).project(point),
                  shifted = moved(camera, {{0, 0, 0}, d}).project(point) -
                            moved(camera, {{0, 0, 0}, -d}).project(point);
      for (int k = 0; k < 2; ++k) {
        EXPECT_NEAR(grad.d_turn[k][axis], turned[k] / (2 * kStep), 1e-4);
        EXPECT_NEAR(grad.d_shift[k][axis], shifted[k] / (2 * kStep), 1e-4);
      }
    }
  }
}

TEST(DollyZoom, ItsGradientIsThatOfFiniteDifferences) {
  const Camera camera = skewed_camera();
  for (uint64_t i = 0; i < 20; ++i) {
    Rng rng(4, 1, i);
    const Vec3d point = 0.3 * Vec3d{rng.normal(), rng.normal(), rng.normal()};
    const Vec2d grad = dolly_zoom_grad(camera, point);
    constexpr double kStep = 1e-6;
    const Vec3d d = dolly_zoomed(camera, std::exp(kStep)).project(point) -
                    dolly_zoomed(camera, std::exp(-kStep)).project(point);
    EXPECT_NEAR(grad.x, d.x / (2 * kStep), 1e-4);
    EXPECT_NEAR(grad.y, d.y / (2 * kStep), 1e-4);
  }
}

// A plane through the origin that faces the camera looks the same; what is before it becomes smaller, because
// from farther away it is less near.
TEST(DollyZoom, KeepsTheSizeOfWhatIsAtTheOrigin) {
  Camera camera;
  camera.fx = camera.fy = 100;
  camera.center = {0, 0, -3};
  const Camera other = dolly_zoomed(camera, 1.1);
  for (const double x : {-0.5, 0.2}) {
    EXPECT_NEAR(other.project({x, 0.3, 0}).x, camera.project({x, 0.3, 0}).x, 1e-9);
    EXPECT_LT(std::abs(other.project({x, 0.3, -1}).x), std::abs(camera.project({x, 0.3, -1}).x));
  }
}

}  // namespace
}  // namespace cei3d
