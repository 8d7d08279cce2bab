// SPDX-License-Identifier: Apache-2.0
// Removes unused vertices and triangles without area.
#pragma once

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// The triangles without vertices that none of them uses, left by removed parts and by simplification. ids:
// the mesh's vertex of each vertex that stays; null: not asked for.
Mesh compact(const Mesh& mesh, std::vector<std::array<uint32_t, 3>> triangles,
             std::vector<uint32_t>* ids = nullptr);

// The triangles that have an area: three different corners that do not lie on a line.
std::vector<std::array<uint32_t, 3>> with_area(const Mesh& mesh);

}  // namespace cei3d
