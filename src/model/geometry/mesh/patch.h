// SPDX-License-Identifier: Apache-2.0
// Patches for the holes of a mesh: as fine as their surroundings, and faired to continue their tangents.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"
#include "model/geometry/mesh/loop_triangles.h"

namespace cei3d {

struct Patch {
  std::vector<Vec3f> positions;  // first the loop's, then new ones
  std::vector<std::array<uint32_t, 3>> triangles;
};

// Triangulates the loop, with triangle sizes that interpolate the edge lengths around it, by Delaunay-like
// flips. Corners 0 .. loop.size() - 1 are the loop's. [Liepa 2003]
Patch fill_loop(std::span<const Vec3f> loop, const IsJoined& joined);

// Moves the free vertices to the minimum of a bending and membrane energy: the surface continues the tangents
// of the fixed vertices over about `bending_length` and is of minimal area beyond. (Continuing the tangents
// all the way would restore most of a part that was cut above its foot.) Needs two rings of fixed vertices
// around the free ones. Vertices without triangles must not be free.
void fair(std::vector<Vec3f>& positions, std::span<const std::array<uint32_t, 3>> triangles,
          std::span<const uint8_t> free, float bending_length);

// Sets the values of free vertices by the discrete Laplace equation. values: #V.
void diffuse(std::span<const Vec3f> positions, std::span<const std::array<uint32_t, 3>> triangles,
             std::span<const uint8_t> free, std::vector<Vec3f>& values);

}  // namespace cei3d
