// SPDX-License-Identifier: Apache-2.0
// Rotations about axes.
#pragma once

#include <cmath>

#include "core/math/tangents.h"

namespace cei3d {

// Rotation by an angle about the unit axis k, counter-clockwise when the axis points to the viewer
// (Rodrigues' formula).
template <class T>
Mat3<T> rotation_about(Vec3<T> k, T radians) {
  const T s = std::sin(radians), c = 1 - std::cos(radians), o = 0;
  const Mat3<T> cross_k{{{o, -k.z, k.y}, {k.z, o, -k.x}, {-k.y, k.x, o}}};
  const Mat3<T> squared = cross_k * cross_k;
  Mat3<T> r = Mat3<T>::identity();
  for (int i = 0; i < 3; ++i) r.row[i] += cross_k.row[i] * s + squared.row[i] * c;
  return r;
}
inline Mat3f about_axis(Vec3f k, float radians) { return rotation_about(k, radians); }

// The shortest rotation that takes one unit vector to another.
inline Mat3f turning(Vec3f from, Vec3f to) {
  const Vec3f axis = cross(from, to);
  const float sine = length(axis), cosine = dot(from, to);
  if (sine < 1e-6f) {
    return cosine > 0 ? Mat3f::identity() : about_axis(-tangents_of(from).x, kPi);
  }
  return about_axis(axis / sine, std::atan2(sine, cosine));
}

// The angle of the rotation about a unit axis that comes nearest to r, in radians: about_axis(axis, angle)
// maximizes the trace of its transpose times r.
inline float angle_about(Vec3f axis, const Mat3f& r) {
  const Vec3f turn{r.row[2].y - r.row[1].z, r.row[0].z - r.row[2].x, r.row[1].x - r.row[0].y};
  const float trace = r.row[0].x + r.row[1].y + r.row[2].z;
  return std::atan2(dot(axis, turn), trace - dot(axis, r * axis));
}

}  // namespace cei3d
