// SPDX-License-Identifier: Apache-2.0
// A patch of new triangles in a hole of a mesh: made as fine as its surroundings, and faired so that it
// carries on their tangents.
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

// Triangles over the loop whose sizes go over from one side's length to another's; the triangulation is as
// good as Delaunay's. Corners 0 .. loop.size() - 1 are the loop's. [Liepa 2003]
Patch fill_loop(std::span<const Vec3f> loop, const IsJoined& joined);

// Moves the free vertices to where a stiff film would have them: over about `bending_length` it carries on
// the tangents of the fixed vertices around it, beyond that it spans them like a soap film. (Carrying the
// tangents on all the way would grow most of a part again that was cut off above its foot.) Needs two rings
// of fixed vertices around the free ones. Vertices that no triangle uses must not be free.
void fair(std::vector<Vec3f>& positions, std::span<const std::array<uint32_t, 3>> triangles,
          std::span<const uint8_t> free, float bending_length);

// Values of the free vertices as smooth as the others allow: the discrete Laplace equation. values: #V.
void diffuse(std::span<const Vec3f> positions, std::span<const std::array<uint32_t, 3>> triangles,
             std::span<const uint8_t> free, std::vector<Vec3f>& values);

}  // namespace cei3d
