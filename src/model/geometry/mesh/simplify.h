// SPDX-License-Identifier: Apache-2.0
// Fewer triangles by collapsing edges in the order of their quadric error. [Garland and Heckbert 1997]
#pragma once

#include "core/math/scalar.h"
#include "model/geometry/mesh/mesh.h"

namespace cei3d {

struct Simplified {
  Mesh mesh;                     // its vertices are vertices of the given mesh, with their normals and colors
  std::vector<uint32_t> vertex;  // #V, which ones
  float error = 0;  // of the last collapse: how far the surface has moved there, unit of the positions
};

// At most `faces` triangles; more where that would close holes or join what is apart. A mesh that has no more
// keeps its triangles, but for those without area. Borders stay borders: their vertices slide along them.
Simplified simplified(const Mesh& mesh, size_t faces);

}  // namespace cei3d
