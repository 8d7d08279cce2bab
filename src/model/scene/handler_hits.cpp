// SPDX-License-Identifier: Apache-2.0
#include "model/scene/handler_hits.h"

namespace cei3d {

std::vector<Hit> handler_hits(const Scene& scene) {
  const HandlerPoints& points = *scene.handlers;
  const size_t n = points.positions.size();
  std::vector<Vec3f> origins(n), directions(n);
  for (size_t i = 0; i < n; ++i) {
    origins[i] = points.positions[i] + points.normals[i] * (0.5f * points.spacing);
    directions[i] = -points.normals[i];
  }
  std::vector<Surface::RayHit> below(n);
  scene.surface->intersect(origins, directions, 0, below);
  std::vector<Hit> hits(n);
  for (size_t i = 0; i < n; ++i) {
    hits[i] = {points.positions[i], points.normals[i], points.normals[i], 0, 0, 0};
    if (below[i].t >= 0)
      hits[i].triangle = below[i].triangle, hits[i].b1 = below[i].b1, hits[i].b2 = below[i].b2;
  }
  return hits;
}

}  // namespace cei3d
