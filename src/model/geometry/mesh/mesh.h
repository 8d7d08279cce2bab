// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

struct Mesh {
  std::vector<Vec3f> positions;                    // #V
  std::vector<Vec3f> normals;                      // #V unit, outward; may be empty
  std::vector<Vec3f> colors;                       // #V linear; may be empty
  std::vector<std::array<uint32_t, 3>> triangles;  // #F, counter-clockwise seen from outside
};

// Values of vertices (#V) at a point of a triangle, by its barycentrics b1 and b2.
inline Vec3f at_corners(std::span<const Vec3f> v, const std::array<uint32_t, 3>& t, float b1, float b2) {
  return v[t[0]] * (1 - b1 - b2) + v[t[1]] * b1 + v[t[2]] * b2;
}

// The vertex of a triangle with the largest barycentric coordinate at a point of it; the first of equals.
inline uint32_t nearest_corner(const std::array<uint32_t, 3>& t, float b1, float b2) {
  const float b0 = 1 - b1 - b2;
  return b0 >= b1 && b0 >= b2 ? t[0] : b1 >= b2 ? t[1] : t[2];
}

}  // namespace cei3d
