// SPDX-License-Identifier: Apache-2.0
// Octahedral map between the sphere and the square [-1, 1]^2: +Z at the center, -Z at the corners.
// [Engelhardt and Dachsbacher 2008]
#pragma once

#include <cmath>

#include "core/math/vec.h"

namespace cei3d {

// Swaps the inner half of the square (upper half of the octahedron) and the outer half (lower half).
inline Vec2f octahedron_folded(Vec2f p) {
  return {std::copysign(1 - std::abs(p.y), p.x), std::copysign(1 - std::abs(p.x), p.y)};
}

// Position in the square of a unit direction d.
inline Vec2f octahedron_from_direction(Vec3f d) {
  const float sum = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  const Vec2f upper{d.x / sum, d.y / sum};
  return d.z < 0 ? octahedron_folded(upper) : upper;
}

// Unit direction of a position in the square; inverse of octahedron_from_direction().
inline Vec3f direction_from_octahedron(Vec2f p) {
  const float z = 1 - std::abs(p.x) - std::abs(p.y);
  const Vec2f upper = z < 0 ? octahedron_folded(p) : p;
  return normalize(Vec3f{upper.x, upper.y, z});
}

}  // namespace cei3d
