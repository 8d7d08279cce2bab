// SPDX-License-Identifier: Apache-2.0
// A change of geometry, as a change of the surface's mesh: vertices that moved, triangles that are gone, new
// matter. Vertex ids mean the same before and after, so that whatever is known of a point of the mesh (a
// triangle and barycentric coordinates) is known of it in every pose of the object, without an inverse of the
// deformation.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/json.h"
#include "core/base/tensors.h"
#include "model/geometry/mesh/mesh.h"

namespace cei3d {

struct Reshape {
  // #M vertices of the mesh before, ascending; where they are now, unit-sphere frame. The gradient of the
  // deformation F (row-major; new from old: dx' = F dx) carries what lies off the mesh along, and normals by
  // its inverse transpose.
  std::vector<uint32_t> moved;
  std::vector<Vec3f> positions, normals;
  std::vector<std::array<float, 9>> gradients;

  std::vector<uint32_t> removed;  // triangles of the mesh before that are gone, ascending

  // New vertices, numbered on from the mesh's; their unit normals and base color (linear).
  std::vector<Vec3f> added_positions, added_normals, added_colors;
  std::vector<std::array<uint32_t, 3>> added_triangles;
  // Old vertices that the added triangles name, ascending, and the base color that the new matter has there.
  std::vector<uint32_t> rim;
  std::vector<Vec3f> rim_colors;

  Mat3f gradient(size_t i) const {
    const auto& m = gradients[i];
    return {{{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}}};
  }
  bool empty() const { return moved.empty() && removed.empty() && added_triangles.empty(); }
};

// The mesh afterwards: old triangles that are left in their order, then the added ones. The mesh has normals.
// Error: a reshape that does not belong to this mesh.
Mesh apply(const Mesh&, const Reshape&);

// The triangles of the mesh before that are left, in their order: the first ones afterwards.
std::vector<uint32_t> kept_triangles(const Mesh& before, const Reshape&);

// Tensors "reshape/...", sizes in the head; and back. Errors: missing tensors or keys, sizes that disagree.
void save_reshape(const Reshape&, Tensors& tensors, Json& head);
Reshape load_reshape(const Tensors& tensors, const Json& head);

}  // namespace cei3d
