// SPDX-License-Identifier: Apache-2.0
// Triangles over a closed polygon in space, without further vertices.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

// Whether two corners of the polygon (indices) are already joined by an edge that is not one of its sides.
using IsJoined = std::function<bool(uint32_t, uint32_t)>;

// The n - 2 triangles with the smallest total area; for a planar polygon of any shape these are the triangles
// inside it. [Barequet and Sharir 1995] Corners are indices into the loop and follow its direction. Diagonals
// that are already joined are avoided. Polygons of more than some hundred corners are first cut by chords, so
// that time grows no faster than n^1.5. n >= 3.
std::vector<std::array<uint32_t, 3>> triangulate_loop(std::span<const Vec3f> loop, const IsJoined& joined);

}  // namespace cei3d
