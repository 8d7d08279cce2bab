// SPDX-License-Identifier: Apache-2.0
// The mesh that assets are written from: with texture coordinates and tangents.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/math/vec2.h"
#include "model/geometry/mesh/mesh.h"
#include "model/geometry/unwrap/atlas.h"

namespace cei3d {

// A mesh whose vertices are split where its texture is.
struct TexturedMesh {
  std::vector<Vec3f> positions, normals, tangents;  // #V; unit normals and tangents
  std::vector<Vec2f> uv;                            // #V, glTF's: v grows downwards; no chart is mirrored
  std::vector<std::array<uint32_t, 3>> triangles;
};

// mesh: with normals.
TexturedMesh textured_mesh(const Mesh& mesh, const Atlas& atlas);

}  // namespace cei3d
