// SPDX-License-Identifier: Apache-2.0
#include "engine/export/surface_below.h"

#include <cmath>

#include "engine/render/render.h"

namespace cei3d {
namespace {

constexpr float kLift = 1e-4f;  // rays start behind the point, which may lie on the surface

using RayHits = std::vector<Surface::RayHit>;

// side: 1 upwards, -1 downwards.
RayHits shoot(const Surface& surface, std::span<const Vec3f> points, std::span<const Vec3f> normals,
              float side) {
  std::vector<Vec3f> origins(points.size()), directions(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    directions[i] = normals[i] * side;
    origins[i] = points[i] - directions[i] * kLift;
  }
  RayHits hits(points.size());
  surface.intersect(origins, directions, 0, hits);
  return hits;
}

// The hit on the mesh, as if seen from above.
Hit hit_at(const Mesh& mesh, const Surface::RayHit& r, Vec3f normal) {
  const auto& t = mesh.triangles[r.triangle];
  return {at_corners(mesh.positions, t, r.b1, r.b2),
          normalize(at_corners(mesh.normals, t, r.b1, r.b2)),
          normal,
          r.triangle,
          r.b1,
          r.b2};
}

}  // namespace

SurfaceBelow surface_below(const Device& device, const Scene& scene, std::span<const Vec3f> points,
                           std::span<const Vec3f> normals, float reach) {
  const Mesh& mesh = scene.surface->mesh();
  const RayHits up = shoot(*scene.surface, points, normals, 1),
                down = shoot(*scene.surface, points, normals, -1);
  SurfaceBelow out;
  for (uint32_t i = 0; i < points.size(); ++i) {
    float nearest = reach + kLift;
    const Surface::RayHit* best = nullptr;
    for (const Surface::RayHit* r : {&up[i], &down[i]}) {
      if (r->t < 0 || r->t > nearest) continue;
      if (dot(hit_at(mesh, *r, normals[i]).normal, normals[i]) <= 0) continue;
      nearest = r->t, best = r;
    }
    if (!best) continue;
    out.hits.push_back(hit_at(mesh, *best, normals[i]));
    out.of_point.push_back(i);
  }
  refine_hits(device, scene, out.hits);
  return out;
}

}  // namespace cei3d
