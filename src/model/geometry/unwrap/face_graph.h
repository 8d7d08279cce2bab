// SPDX-License-Identifier: Apache-2.0
// Neighborhood of the faces of a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

inline constexpr uint32_t kNoFace = ~0u;

// What charts are grown by: the faces of a mesh and which of them share an edge.
struct FaceGraph {
  // #F, the face across the edge from corner k to corner k + 1. kNoFace: a border, an edge of more than two
  // faces, or one that its two faces run through in the same direction.
  std::vector<std::array<uint32_t, 3>> across;
  std::vector<std::array<float, 3>> edges;  // #F, their lengths
  std::vector<Vec3f> centers, normals;      // #F; unit
  std::vector<float> areas;                 // #F

  size_t size() const { return across.size(); }
};

// Slivers get the mean normal of their neighbors, because their own is inaccurate.
FaceGraph face_graph(std::span<const Vec3f> positions, std::span<const std::array<uint32_t, 3>> triangles);

}  // namespace cei3d
