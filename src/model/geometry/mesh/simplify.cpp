// SPDX-License-Identifier: Apache-2.0
// The only file that knows meshoptimizer.
#include "model/geometry/mesh/simplify.h"

#include <meshoptimizer.h>

#include <limits>

#include "model/geometry/mesh/compact.h"

namespace cei3d {

Simplified simplified(const Mesh& mesh, size_t faces) {
  Simplified out;
  const Mesh clean = compact(mesh, with_area(mesh));
  if (clean.triangles.size() <= faces) return {clean, 0};
  std::vector<std::array<uint32_t, 3>> kept(clean.triangles.size());
  const float* positions = &clean.positions[0].x;
  const size_t vertices = clean.positions.size();
  const size_t indices =
      meshopt_simplify(kept[0].data(), clean.triangles[0].data(), kept.size() * 3, positions, vertices,
                       sizeof(Vec3f), faces * 3, std::numeric_limits<float>::max(), 0, &out.error);
  kept.resize(indices / 3);
  out.error *= meshopt_simplifyScale(positions, vertices, sizeof(Vec3f));
  out.mesh = compact(clean, std::move(kept));
  out.mesh = compact(out.mesh, with_area(out.mesh));
  return out;
}

}  // namespace cei3d
