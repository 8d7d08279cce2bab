// SPDX-License-Identifier: Apache-2.0
// Rays meet the mesh first and are then moved onto the zero set of the field, so a frame costs a few field
// evaluations a sample and silhouettes are those of the mesh.
#include <algorithm>
#include <cmath>

#include "engine/render/render.h"
#include "model/geometry/sdf_normals.h"

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
                 std::span<Hit> hits, std::span<float> edges) {
  std::vector<Vec3f> points(hits.size()), normals(hits.size());
  constexpr float kMost = 0.01f;  // a mesh cell or so
  for (int round = 0; round < 2; ++round) {
    for (size_t i = 0; i < hits.size(); ++i) points[i] = hits[i].position;
    const std::vector<float> d = first_output(device, sdf, points);
    for (size_t i = 0; i < hits.size(); ++i) {
      const float cosine = std::max(0.2f, -dot(hits[i].normal, directions[i]));
      hits[i].position += directions[i] * std::clamp(d[i] / cosine, -kMost, kMost);
    }
  }
  for (size_t i = 0; i < hits.size(); ++i) points[i] = hits[i].position;
  sdf_normals(device, sdf, points, normals, edges);
  for (size_t i = 0; i < hits.size(); ++i) hits[i].normal = normals[i];
}

namespace {

// Where rays meet the mesh, with its interpolated normals.
std::vector<Hit> mesh_hits(const Surface& surface, std::span<const Ray> rays,
                           std::vector<uint32_t>& ray_of_hit) {
  std::vector<Vec3f> origins(rays.size()), directions(rays.size());
  for (size_t i = 0; i < rays.size(); ++i) origins[i] = rays[i].origin, directions[i] = rays[i].direction;
  std::vector<Surface::RayHit> found(rays.size());
  surface.intersect(origins, directions, 0, found);
  std::vector<Hit> hits;
  ray_of_hit.clear();
  const Mesh& mesh = surface.mesh();
  for (size_t i = 0; i < rays.size(); ++i) {
    if (found[i].t < 0) continue;
    const auto& t = mesh.triangles[found[i].triangle];
    const Vec3f n = mesh.normals[t[0]] * (1 - found[i].b1 - found[i].b2) + mesh.normals[t[1]] * found[i].b1 +
                    mesh.normals[t[2]] * found[i].b2;
    hits.push_back({rays[i].origin + rays[i].direction * found[i].t, normalize(n), -rays[i].direction,
                    found[i].triangle, found[i].b1, found[i].b2});
    ray_of_hit.push_back(uint32_t(i));
  }
  return hits;
}

void refine_along_rays(const Device& device, const Field& sdf, std::vector<Hit>& hits) {
  std::vector<Vec3f> directions;
  for (const Hit& h : hits) directions.push_back(-h.to_camera);
  refine_hits(device, sdf, directions, hits);
}

// A hit on changed matter, taken back to pose 0 together with its ray, and forth again: the field knows pose
// 0 only.
struct RestHit {
  uint32_t index;
  std::array<uint32_t, 3> corners;
  Mat3f gradient;
  Vec3f point;  // of the mesh in pose 0
};

RestHit to_rest(const Poses& poses, uint32_t index, Hit& hit, Vec3f& direction) {
  const Pose &now = *poses.back(), &rest = *poses.front();
  RestHit r{index, now.surface->mesh().triangles[hit.triangle], {}, {}};
  r.gradient = gradient_at(now, r.corners, hit);
  r.point = mesh_point(rest, r.corners, hit);
  hit.position = r.point;
  hit.normal = normalize(transpose(r.gradient) * hit.normal);
  direction = normalize(inverse(r.gradient) * direction);
  return r;
}

void from_rest(const Poses& poses, const RestHit& r, const Hit& refined, Hit& hit) {
  hit.position = mesh_point(*poses.back(), r.corners, hit) + r.gradient * (refined.position - r.point);
  hit.normal = normalize(inverse_transpose(r.gradient) * refined.normal);
}

// New matter is where its mesh is; what moved is refined where it was; all else as if nothing had happened.
void refine_posed(const Device& device, const Scene& scene, std::vector<Hit>& hits) {
  const Pose& now = *scene.poses.back();
  std::vector<RestHit> moved;
  std::vector<uint32_t> of;
  std::vector<Hit> field_hits;
  std::vector<Vec3f> directions;
  for (uint32_t i = 0; i < hits.size(); ++i) {
    if (now.born_in(hits[i].triangle) > 0) continue;
    of.push_back(i);
    field_hits.push_back(hits[i]);
    directions.push_back(-hits[i].to_camera);
    if (now.shaped_in(hits[i].triangle) > 0)
      moved.push_back(to_rest(scene.poses, uint32_t(of.size() - 1), field_hits.back(), directions.back()));
  }
  refine_hits(device, *scene.sdf, directions, field_hits);
  auto back = moved.begin();
  for (uint32_t k = 0; k < of.size(); ++k) {
    if (back != moved.end() && back->index == k)
      from_rest(scene.poses, *back++, field_hits[k], hits[of[k]]);
    else
      hits[of[k]] = field_hits[k];
  }
}

}  // namespace

std::vector<Hit> trace_rays(const Device& device, const Field& sdf, const Surface& surface,
                            std::span<const Ray> rays, std::vector<uint32_t>& ray_of_hit) {
  std::vector<Hit> hits = mesh_hits(surface, rays, ray_of_hit);
  refine_along_rays(device, sdf, hits);
  return hits;
}

std::vector<Hit> trace_rays(const Device& device, const Scene& scene, std::span<const Ray> rays,
                            std::vector<uint32_t>& ray_of_hit) {
  if (scene.poses.empty()) return trace_rays(device, *scene.sdf, *scene.surface, rays, ray_of_hit);
  std::vector<Hit> hits = mesh_hits(*scene.surface, rays, ray_of_hit);
  refine_posed(device, scene, hits);
  return hits;
}

GBuffer trace_view(const Device& device, const Scene& scene, const Camera& camera, int samples) {
  const Samples s = camera_samples(camera, samples);
  GBuffer g{camera.width, camera.height, samples, {}, {}, {}, {}};
  std::vector<uint32_t> ray_of_hit;
  g.hits = trace_rays(device, scene, s.rays, ray_of_hit);
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
