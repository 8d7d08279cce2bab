// SPDX-License-Identifier: Apache-2.0
// Small motions of cameras.
#pragma once

#include "core/math/camera.h"
#include "core/math/rotation.h"

namespace cei3d {

// turn: rotation about the origin, by |turn| radians about its direction. shift: after it, world units.
struct RigidMotion {
  Vec3d turn{0, 0, 0}, shift{0, 0, 0};
};

inline Mat3d rotation_of(Vec3d turn) {
  const double angle = length(turn);
  if (angle == 0) return Mat3d::identity();
  return rotation_about(turn / angle, angle);
}

inline Camera moved(Camera camera, const RigidMotion& m) {
  const Mat3d r = rotation_of(m.turn);
  camera.world_from_cam = r * camera.world_from_cam;
  camera.center = r * camera.center + m.shift;
  return camera;
}

}  // namespace cei3d
