// SPDX-License-Identifier: Apache-2.0
// Areas of a mesh that belong to its vertices.
#pragma once

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// A third of the area of the triangles around each vertex: #V.
std::vector<double> vertex_areas(const Mesh&);

}  // namespace cei3d
