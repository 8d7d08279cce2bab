// SPDX-License-Identifier: Apache-2.0
// Small motions of cameras, and changes of their focal length.
#pragma once

#include "core/math/camera.h"
#include "core/math/rotation.h"
#include "core/math/vec2.h"

namespace cei3d {

// Of a camera in the frame of its pose. turn: rotation about the origin, by |turn| radians about its
// direction. shift: after it.
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

// Inverse of rotation_of(), for turns of less than a half circle.
inline Vec3d turn_of(const Mat3d& r) {
  const Vec3d twice_sine{r.row[2].y - r.row[1].z, r.row[0].z - r.row[2].x, r.row[1].x - r.row[0].y};
  const double sine = length(twice_sine) / 2, cosine = (r.row[0].x + r.row[1].y + r.row[2].z - 1) / 2;
  return sine < 1e-12 ? twice_sine * 0.5 : twice_sine * (std::atan2(sine, cosine) / (2 * sine));
}

// Derivative of the continuous pixel position of a point, given in the frame of the pose, by a motion of the
// camera, at no motion: row 0 of x, row 1 of y; columns turn (3) and shift (3).
struct MotionGrad {
  Vec3d d_turn[2], d_shift[2];
};
inline MotionGrad motion_grad(const Camera& camera, Vec3d point) {
  const Mat3d cam_from_world = transpose(camera.world_from_cam);
  const Vec3d c = cam_from_world * (point - camera.center);
  const Vec3d d_c[2] = {
      {camera.fx / c.z, camera.skew / c.z, -(camera.fx * c.x + camera.skew * c.y) / (c.z * c.z)},
      {0, camera.fy / c.z, -camera.fy * c.y / (c.z * c.z)}};
  MotionGrad out;
  for (int i = 0; i < 2; ++i) {
    // Seen from the moved camera the point moves by -(turn x point + shift).
    const Vec3d d_point = camera.world_from_cam * d_c[i];
    out.d_shift[i] = -d_point;
    out.d_turn[i] = cross(d_point, point);
  }
  return out;
}

// The motion that takes one camera to the other.
inline RigidMotion motion_between(const Camera& from, const Camera& to) {
  const Mat3d r = to.world_from_cam * transpose(from.world_from_cam);
  return {turn_of(r), to.center - r * from.center};
}

// `factor` times the focal length, and as many times as far from the origin: what is there stays as large in
// the image, only its perspective changes.
inline Camera dolly_zoomed(const Camera& camera, double factor) {
  Camera out = zoomed(camera, factor);
  out.center = out.center * factor;
  return out;
}

// Derivative of the continuous pixel position of a point, given in the frame of the pose, by the logarithm of
// the factor of dolly_zoomed(), at a factor of 1.
inline Vec2d dolly_zoom_grad(const Camera& camera, Vec3d point) {
  const Vec3d at = camera.project(point);
  const MotionGrad grad = motion_grad(camera, point);
  return {at.x - camera.cx + dot(grad.d_shift[0], camera.center),
          at.y - camera.cy + dot(grad.d_shift[1], camera.center)};
}

}  // namespace cei3d
