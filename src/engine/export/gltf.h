// SPDX-License-Identifier: Apache-2.0
// Meshes as binary glTF 2.0 (.glb) with vertex colors and a metallic-roughness material. [Khronos glTF 2.0]
#pragma once

#include <string>
#include <vector>

#include "engine/export/placement.h"
#include "model/geometry/mesh/mesh.h"
#include "model/material/material.h"

namespace cei3d {

// Materials of a mesh, per triangle.
struct MeshMaterials {
  std::vector<Material> list;
  std::vector<uint32_t> of_triangle;  // #F, index in the list; empty: the first for all
};

// Writes POSITION, NORMAL and COLOR_0 (linear, float) where the mesh has them; one primitive per used
// material, with roughness and metalness as factors; a specular other than 0.5 as KHR_materials_specular.
// Vertices stay in the capture frame; the node holds the placement.
std::string encode_glb(const Mesh& mesh, const MeshMaterials& materials, const Placement& placement);

}  // namespace cei3d
