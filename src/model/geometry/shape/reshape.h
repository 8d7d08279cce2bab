// SPDX-License-Identifier: Apache-2.0
// A change of shape as a change of the mesh: vertices that moved, triangles that were removed, new vertices
// and triangles. Vertex ids mean the same before and after, so a point of the mesh (a triangle and
// barycentric coordinates) can be followed through all shape versions without inverting the deformation.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/json_fwd.h"
#include "core/base/tensors.h"
#include "model/geometry/mesh/mesh.h"

namespace cei3d {

struct Reshape {
  // #M ids of moved vertices, ascending; their new positions and normals, unit frame; and deformation
  // gradients F (row-major, dx' = F dx), which carry offsets from the mesh along, and normals by the inverse
  // transpose.
  std::vector<uint32_t> moved;
  std::vector<Vec3f> positions, normals;
  std::vector<std::array<float, 9>> gradients;

  std::vector<uint32_t> removed;  // ids of removed triangles, ascending

  // New vertices, numbered after the mesh's; unit normals and linear albedo.
  std::vector<Vec3f> added_positions, added_normals, added_colors;
  std::vector<std::array<uint32_t, 3>> added_triangles;
  // Old vertices that the added triangles use, ascending, and the albedo of the added surface there.
  std::vector<uint32_t> rim;
  std::vector<Vec3f> rim_colors;

  Mat3f gradient(size_t i) const {
    const auto& m = gradients[i];
    return {{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}}};
  }
  bool empty() const { return moved.empty() && removed.empty() && added_triangles.empty(); }
};

// The mesh after the change: remaining triangles in their order, then the added ones. The mesh has normals.
// Error: the reshape does not belong to this mesh.
Mesh apply(const Mesh&, const Reshape&);

// Ids of the triangles that remain, in their order: the first ones after the change.
std::vector<uint32_t> kept_triangles(const Mesh& before, const Reshape&);

// Writes tensors "reshape/...", sizes to the head. Errors of loading: missing tensors or keys, sizes that
// disagree.
void save_reshape(const Reshape&, Tensors& tensors, Json& head);
Reshape load_reshape(const Tensors& tensors, const Json& head, const std::string& what = "A change of shape");

}  // namespace cei3d
