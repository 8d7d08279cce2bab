// SPDX-License-Identifier: Apache-2.0
// A frame around a direction.
#pragma once

#include <cmath>

#include "core/math/vec.h"

namespace cei3d {

// x and y axes of a right-handed frame whose z axis is given.
template <class T>
struct Tangents {
  Vec3<T> x, y;
};

// z: unit. x is perpendicular to the coordinate axis `first` (0, 1, 2), too, and where z is near that one, to
// the next.
template <class T>
Tangents<T> tangents_of(Vec3<T> z, int first = 0) {
  Vec3<T> axis{0, 0, 0};
  axis[std::abs(z[first]) < T(0.9) ? first : (first + 1) % 3] = 1;
  const Vec3<T> x = normalize(cross(axis, z));
  return {x, cross(z, x)};
}

}  // namespace cei3d
