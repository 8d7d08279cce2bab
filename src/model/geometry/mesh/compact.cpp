// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/compact.h"

#include <algorithm>

namespace cei3d {

Mesh compact(const Mesh& mesh, std::vector<std::array<uint32_t, 3>> triangles, std::vector<uint32_t>* ids) {
  constexpr uint32_t kUnused = ~0u;
  std::vector<uint32_t> id(mesh.positions.size(), kUnused);
  Mesh out;
  out.triangles = std::move(triangles);
  for (auto& t : out.triangles)
    for (uint32_t& v : t) {
      if (id[v] == kUnused) {
        id[v] = uint32_t(out.positions.size());
        out.positions.push_back(mesh.positions[v]);
        if (ids) ids->push_back(v);
        if (!mesh.normals.empty()) out.normals.push_back(mesh.normals[v]);
        if (!mesh.colors.empty()) out.colors.push_back(mesh.colors[v]);
      }
      v = id[v];
    }
  return out;
}

std::vector<std::array<uint32_t, 3>> with_area(const Mesh& mesh) {
  constexpr float kFlat = 1e-6f;  // maximum ratio of the height of a flat triangle to its longest side
  std::vector<std::array<uint32_t, 3>> out;
  for (const auto& t : mesh.triangles) {
    const Vec3f a = mesh.positions[t[1]] - mesh.positions[t[0]],
                b = mesh.positions[t[2]] - mesh.positions[t[0]];
    const float longest = std::max({dot(a, a), dot(b, b), dot(b - a, b - a)});
    if (length(cross(a, b)) > kFlat * longest) out.push_back(t);
  }
  return out;
}

}  // namespace cei3d
