// SPDX-License-Identifier: Apache-2.0
// The only file that knows meshoptimizer.
#include "model/geometry/mesh/simplify.h"

#include <meshoptimizer.h>

#include <limits>

#include "model/geometry/mesh/compact.h"

namespace cei3d {

namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;

// Returns the error.
float collapse(const Mesh& mesh, size_t faces, Triangles& triangles) {
  Triangles kept(triangles.size());
  const float* positions = &mesh.positions[0].x;
  const size_t vertices = mesh.positions.size();
  float error = 0;
  const size_t indices =
      meshopt_simplify(kept[0].data(), triangles[0].data(), triangles.size() * 3, positions, vertices,
                       sizeof(Vec3f), faces * 3, std::numeric_limits<float>::max(), 0, &error);
  kept.resize(indices / 3);
  triangles = std::move(kept);
  return error * meshopt_simplifyScale(positions, vertices, sizeof(Vec3f));
}

}  // namespace

Simplified simplified(const Mesh& mesh, size_t faces) {
  Simplified out;
  Mesh clean{mesh.positions, {}, {}, with_area(mesh)};
  if (clean.triangles.size() > faces) {
    std::vector<uint32_t> ids;
    Mesh used = compact(mesh, clean.triangles, &ids);
    out.error = collapse(used, faces, used.triangles);
    clean.triangles = with_area(used);
    for (auto& t : clean.triangles)
      for (uint32_t& v : t) v = ids[v];
  }
  out.mesh = compact(mesh, std::move(clean.triangles), &out.vertex);
  return out;
}

}  // namespace cei3d
