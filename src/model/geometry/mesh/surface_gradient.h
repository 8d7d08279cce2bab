// SPDX-License-Identifier: Apache-2.0
// Deformation gradient at the vertices of a deformed mesh.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

struct SurfaceGradient {
  // #vertices, row-major F: a small offset d from the vertex becomes F d.
  std::vector<std::array<float, 9>> gradients;
  std::vector<Vec3f> normals;  // #vertices, unit: F^-T n
};

// For each of `vertices`. Along the surface F is the least-squares fit to the edges around the vertex;
// offsets along the normal keep their length and stay along the normal. before, after: #V positions; normals:
// #V, unit, before.
SurfaceGradient surface_gradient(std::span<const Vec3f> before, std::span<const Vec3f> normals,
                                 std::span<const Vec3f> after,
                                 std::span<const std::array<uint32_t, 3>> triangles,
                                 std::span<const uint32_t> vertices);

}  // namespace cei3d
