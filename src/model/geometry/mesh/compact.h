// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// The triangles without vertices that none of them uses, left by removed parts and by simplification.
Mesh compact(const Mesh& mesh, std::vector<std::array<uint32_t, 3>> triangles);

// The triangles that have an area: three different corners that do not lie on a line.
std::vector<std::array<uint32_t, 3>> with_area(const Mesh& mesh);

}  // namespace cei3d
