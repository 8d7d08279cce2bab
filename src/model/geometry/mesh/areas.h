// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// Of every vertex, a third of the area of the triangles around it: #V.
std::vector<double> vertex_areas(const Mesh&);

}  // namespace cei3d
