// SPDX-License-Identifier: Apache-2.0
// Triangle meshes, and values of vertices inside a triangle.
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

// The barycentrics of all three corners.
inline std::array<float, 3> barycentrics(float b1, float b2) { return {1 - b1 - b2, b1, b2}; }

// Values of vertices (#V, of any linear type) at a point of a triangle, by its barycentrics.
template <class Values>
auto at_corners(const Values& v, const std::array<uint32_t, 3>& t, const std::array<float, 3>& b) {
  return v[t[0]] * b[0] + v[t[1]] * b[1] + v[t[2]] * b[2];
}
template <class Values>
auto at_corners(const Values& v, const std::array<uint32_t, 3>& t, float b1, float b2) {
  return at_corners(v, t, barycentrics(b1, b2));
}

inline float triangle_area(const Mesh& mesh, const std::array<uint32_t, 3>& t) {
  const Vec3f a = mesh.positions[t[0]];
  return 0.5f * length(cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a));
}

// The vertex of a triangle with the largest barycentric coordinate at a point of it; the first of equals.
inline uint32_t nearest_corner(const std::array<uint32_t, 3>& t, float b1, float b2) {
  const float b0 = barycentrics(b1, b2)[0];
  return b0 >= b1 && b0 >= b2 ? t[0] : b1 >= b2 ? t[1] : t[2];
}

}  // namespace cei3d
