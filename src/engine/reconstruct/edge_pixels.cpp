// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/edge_pixels.h"

#include <array>
#include <cmath>

#include "model/geometry/shape/surface.h"

namespace cei3d {

namespace {

constexpr std::array<Vec2f, 4> kBeside{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};  // pixels
// Maximum distance of a neighbor from the tangent plane, in pixels on the surface. What stands out by less
// is mostly of one material.
constexpr float kMaxStep = 2;

bool same_surface(const Hit& hit, const Ray& beside, const Surface::RayHit& found, float footprint) {
  if (found.t < 0) return false;
  const Vec3f away = beside.origin + beside.direction * found.t - hit.position;
  return std::abs(dot(away, hit.normal)) <= kMaxStep * footprint;
}

}  // namespace

std::vector<uint8_t> on_edges(const Surface& surface, std::span<const Camera> cameras,
                              std::span<const Hit> hits, std::span<const SeenAt> seen) {
  std::vector<Ray> rays;
  std::vector<Vec3f> origins, directions;
  for (const SeenAt& p : seen)
    for (const Vec2f away : kBeside) {
      rays.push_back(cameras[p.view].ray(float(p.x) + 0.5f + away.x, float(p.y) + 0.5f + away.y));
      origins.push_back(rays.back().origin);
      directions.push_back(rays.back().direction);
    }
  std::vector<Surface::RayHit> found(rays.size());
  surface.intersect(origins, directions, 0, found);
  std::vector<uint8_t> edge(hits.size());
  for (size_t i = 0; i < rays.size(); ++i) {
    const Hit& hit = hits[i / kBeside.size()];
    const Camera& camera = cameras[seen[i / kBeside.size()].view];
    const float footprint = length(hit.position - to_float(camera.center)) / float(camera.fx);
    edge[i / kBeside.size()] |= !same_surface(hit, rays[i], found[i], footprint);
  }
  return edge;
}

}  // namespace cei3d
