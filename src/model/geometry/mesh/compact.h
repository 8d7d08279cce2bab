// SPDX-License-Identifier: Apache-2.0
// Removes unused vertices and triangles without area.
#pragma once

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// The mesh of these triangles alone. Vertices that none of them uses, which removed parts and simplification
// leave, are dropped. ids: gets the mesh's vertex of each vertex that stays; may be null.
Mesh compact(const Mesh& mesh, std::vector<std::array<uint32_t, 3>> triangles,
             std::vector<uint32_t>* ids = nullptr);

// The triangles that have an area: three different corners that do not lie on a line.
std::vector<std::array<uint32_t, 3>> with_area(const Mesh& mesh);

}  // namespace cei3d
