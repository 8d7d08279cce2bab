// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/areas.h"

namespace cei3d {

std::vector<double> vertex_areas(const Mesh& mesh) {
  std::vector<double> area(mesh.positions.size(), 0.0);
  for (const auto& t : mesh.triangles)
    for (const uint32_t v : t) area[v] += double(triangle_area(mesh, t)) / 3;
  return area;
}

}  // namespace cei3d
