// SPDX-License-Identifier: Apache-2.0
// Rays meet the mesh first and are then moved onto the zero set of the field, so a frame costs a few field
// evaluations a sample and silhouettes are those of the mesh.
#include <algorithm>
#include <cmath>

#include "engine/render/render.h"
#include "model/geometry/surface_nets.h"

namespace cei3d {

namespace {

struct Samples {
  std::vector<Ray> rays;
  std::vector<uint32_t> pixels;
};

// All sub-pixel rays of a view, pixel after pixel.
Samples camera_samples(const Camera& camera, int samples) {
  Samples s;
  const size_t n = size_t(camera.width) * camera.height * samples * samples;
  s.rays.reserve(n);
  s.pixels.reserve(n);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x)
      for (int k = 0; k < samples * samples; ++k) {
        s.rays.push_back(camera.ray(x + (k % samples + 0.5) / samples, y + (k / samples + 0.5) / samples));
        s.pixels.push_back(uint32_t(y * camera.width + x));
      }
  return s;
}

}  // namespace

void refine_hits(const Device& device, const Field& sdf, std::span<const Vec3f> directions,
                 std::span<Hit> hits) {
  const size_t outputs = size_t(sdf.config().outputs);
  std::vector<Vec3f> points(hits.size()), normals(hits.size());
  std::vector<float> d(hits.size() * outputs);
  constexpr float kMost = 0.01f;  // a mesh cell or so
  for (int round = 0; round < 2; ++round) {
    for (size_t i = 0; i < hits.size(); ++i) points[i] = hits[i].position;
    sdf.eval(device, points, d);
    for (size_t i = 0; i < hits.size(); ++i) {
      const float cosine = std::max(0.2f, -dot(hits[i].normal, directions[i]));
      hits[i].position += directions[i] * std::clamp(d[i * outputs] / cosine, -kMost, kMost);
    }
  }
  for (size_t i = 0; i < hits.size(); ++i) points[i] = hits[i].position;
  sdf_normals(device, sdf, points, normals);
  for (size_t i = 0; i < hits.size(); ++i) hits[i].normal = normals[i];
}

std::vector<Hit> trace_rays(const Device& device, const Field& sdf, const Surface& surface,
                            std::span<const Ray> rays, std::vector<uint32_t>& ray_of_hit) {
  std::vector<Vec3f> origins(rays.size()), directions(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) origins[i] = rays[i].origin, directions[i] = rays[i].direction;
  std::vector<Surface::RayHit> found(rays.size());
  surface.intersect(origins, directions, 0, found);
  std::vector<Hit> hits;
  std::vector<Vec3f> hit_directions;
  ray_of_hit.clear();
  const Mesh& mesh = surface.mesh();
  for (size_t i = 0; i < rays.size(); ++i) {
    if (found[i].t < 0) continue;
    const auto& t = mesh.triangles[found[i].triangle];
    const Vec3f n = mesh.normals[t[0]] * (1 - found[i].b1 - found[i].b2) + mesh.normals[t[1]] * found[i].b1 +
                    mesh.normals[t[2]] * found[i].b2;
    hits.push_back({rays[i].origin + rays[i].direction * found[i].t, normalize(n), -rays[i].direction,
                    found[i].triangle, found[i].b1, found[i].b2});
    hit_directions.push_back(rays[i].direction);
    ray_of_hit.push_back(uint32_t(i));
  }
  refine_hits(device, sdf, hit_directions, hits);
  return hits;
}

GBuffer trace_view(const Device& device, const Scene& scene, const Camera& camera, int samples) {
  const Samples s = camera_samples(camera, samples);
  GBuffer g{camera.width, camera.height, samples, {}, {}, {}, {}};
  std::vector<uint32_t> ray_of_hit;
  g.hits = trace_rays(device, *scene.sdf, *scene.surface, s.rays, ray_of_hit);
  g.pixel_start.assign(size_t(camera.width) * camera.height + 1, 0);
  const Vec3f forward = camera.forward(), center = to_float(camera.center);
  for (size_t i = 0; i < g.hits.size(); ++i) {
    ++g.pixel_start[s.pixels[ray_of_hit[i]] + 1];
    g.sub_pixels.push_back(uint16_t(ray_of_hit[i] % uint32_t(samples * samples)));
    g.depths.push_back(dot(g.hits[i].position - center, forward));
  }
  for (size_t p = 1; p < g.pixel_start.size(); ++p) g.pixel_start[p] += g.pixel_start[p - 1];
  return g;
}

}  // namespace cei3d
