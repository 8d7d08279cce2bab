// SPDX-License-Identifier: Apache-2.0
// Tangents for normal maps, equal to those that MikkTSpace makes, which programs that read no tangents
// compute themselves. [Mikkelsen 2008]
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec2.h"

namespace cei3d {

// #V, unit, perpendicular to the normals: the directions in which u grows, of the triangles around a vertex,
// weighted by their angles there. Vertices are split where the texture is, and no chart is mirrored, so that
// no triangles have to be told apart. uv: glTF's. A vertex whose triangles have no area in the texture gets
// any perpendicular.
std::vector<Vec3f> tangents_of(std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                               std::span<const Vec2f> uv, std::span<const std::array<uint32_t, 3>> triangles);

// The frame of a normal map at a point: tangent and normal interpolated and not made unit, as viewers have
// them.
struct TangentFrame {
  Vec3f tangent, normal;

  // What the map has to say for the viewer to find this direction, unit. The bitangent is normal x tangent:
  // the map is not mirrored.
  Vec3f coordinates(Vec3f direction) const;
  Vec3f direction(Vec3f coordinates) const;  // the viewer's part, unit
};

}  // namespace cei3d
