// SPDX-License-Identifier: Apache-2.0
// Rays meet the mesh first and are then moved onto the zero set of the field, so a frame costs a few field
// evaluations per sample and silhouettes are those of the mesh.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/math/sub_pixel.h"
#include "engine/render/render.h"
#include "model/geometry/shape/sdf_normals.h"

namespace cei3d {

void refine_hits(const Device& device, const Field& sdf, std::span<const Vec3f> directions,
                 std::span<Hit> hits, std::span<float> edges) {
  std::vector<Vec3f> points(hits.size()), normals(hits.size());
  constexpr float kMaxStep = 0.01f;  // about a mesh cell
  for (int round = 0; round < 2; ++round) {
    for (size_t i = 0; i < hits.size(); ++i) points[i] = hits[i].position;
    const std::vector<float> d = first_output(device, sdf, points);
    for (size_t i = 0; i < hits.size(); ++i) {
      const float cosine = std::max(0.2f, -dot(hits[i].normal, directions[i]));
      hits[i].position += directions[i] * std::clamp(d[i] / cosine, -kMaxStep, kMaxStep);
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
    const Vec3f n = at_corners(mesh.normals, t, found[i].b1, found[i].b2);
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

// Maps a hit on changed surface and its ray to shape version 0, the only one that the field represents, and
// back.
struct RestHit {
  uint32_t index;
  std::array<uint32_t, 3> corners;
  Mat3f gradient;
  Vec3f point;  // of the mesh in version 0
};

RestHit to_rest(const ShapeVersions& versions, uint32_t index, Hit& hit, Vec3f& direction) {
  const ShapeVersion &now = *versions.back(), &rest = *versions.front();
  RestHit r{index, now.surface->mesh().triangles[hit.triangle], {}, {}};
  r.gradient = gradient_at(now, r.corners, hit);
  r.point = mesh_point(rest, r.corners, hit);
  hit.position = r.point;
  hit.normal = normalize(transpose(r.gradient) * hit.normal);
  direction = normalize(inverse(r.gradient) * direction);
  return r;
}

void from_rest(const ShapeVersions& versions, const RestHit& r, const Hit& refined, Hit& hit) {
  hit.position = mesh_point(*versions.back(), r.corners, hit) + r.gradient * (refined.position - r.point);
  hit.normal = normalize(inverse_transpose(r.gradient) * refined.normal);
}

// The version that gave a hit's triangle its shape, if it has a distance field of its own; else 0.
int version_with_field(const ShapeVersions& versions, const Hit& hit) {
  const ShapeVersion& now = *versions.back();
  const int k = now.shaped_in(hit.triangle);
  return now.born_in(hit.triangle) == 0 && versions[size_t(k)]->sdf ? k : 0;
}

// Refines hits on surface that has a field of its own, in place.
void refine_on_own_fields(const Device& device, const ShapeVersions& versions, std::vector<Hit>& hits) {
  std::vector<std::vector<uint32_t>> by_version(versions.size());
  for (uint32_t i = 0; i < hits.size(); ++i)
    if (const int k = version_with_field(versions, hits[i])) by_version[size_t(k)].push_back(i);
  for (size_t k = 0; k < versions.size(); ++k) {
    std::vector<Hit> own;
    for (const uint32_t i : by_version[k]) own.push_back(hits[i]);
    if (!own.empty()) refine_along_rays(device, *versions[k]->sdf, own);
    for (size_t j = 0; j < own.size(); ++j) hits[by_version[k][j]] = own[j];
  }
}

// Added surface is its mesh; moved surface is refined on its own field, or in shape version 0; the rest is
// refined in place.
void refine_changed(const Device& device, const Scene& scene, std::vector<Hit>& hits) {
  const ShapeVersion& now = *scene.shape_versions.back();
  refine_on_own_fields(device, scene.shape_versions, hits);
  std::vector<RestHit> moved;
  std::vector<uint32_t> of;
  std::vector<Hit> field_hits;
  std::vector<Vec3f> directions;
  for (uint32_t i = 0; i < hits.size(); ++i) {
    if (now.born_in(hits[i].triangle) > 0 || version_with_field(scene.shape_versions, hits[i])) continue;
    of.push_back(i);
    field_hits.push_back(hits[i]);
    directions.push_back(-hits[i].to_camera);
    if (now.shaped_in(hits[i].triangle) > 0)
      moved.push_back(
          to_rest(scene.shape_versions, uint32_t(of.size() - 1), field_hits.back(), directions.back()));
  }
  refine_hits(device, *scene.sdf, directions, field_hits);
  auto back = moved.begin();
  for (uint32_t k = 0; k < of.size(); ++k) {
    if (back != moved.end() && back->index == k)
      from_rest(scene.shape_versions, *back++, field_hits[k], hits[of[k]]);
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
                            std::vector<uint32_t>& ray_of_hit, OnSurface on) {
  std::vector<Hit> hits = mesh_hits(*scene.surface, rays, ray_of_hit);
  if (on == OnSurface::field) refine_hits(device, scene, hits);
  return hits;
}

void refine_hits(const Device& device, const Scene& scene, std::vector<Hit>& hits) {
  if (scene.shape_versions.empty())
    refine_along_rays(device, *scene.sdf, hits);
  else
    refine_changed(device, scene, hits);
}

namespace {

// Hits of the rays of some pixels, ordered by pixel.
struct PixelHits {
  std::vector<Hit> hits;
  std::vector<uint16_t> sub_pixels;  // #hits
  std::vector<uint32_t> start;       // #pixels + 1
};

PixelHits trace_pixels(const Device& device, const Scene& scene, const Camera& camera,
                       std::span<const uint32_t> pixels, int samples, OnSurface on) {
  const uint32_t each = uint32_t(samples * samples);
  std::vector<Ray> rays;
  rays.reserve(pixels.size() * each);
  for (const uint32_t p : pixels)
    for (uint32_t k = 0; k < each; ++k) {
      const Vec2f at = sub_pixel(int(k), samples);
      rays.push_back(
          camera.ray(double(p % uint32_t(camera.width)) + at.x, double(p / uint32_t(camera.width)) + at.y));
    }
  PixelHits out;
  std::vector<uint32_t> ray_of_hit;
  out.hits = trace_rays(device, scene, rays, ray_of_hit, on);
  out.start.assign(pixels.size() + 1, 0);
  for (const uint32_t ray : ray_of_hit) {
    out.sub_pixels.push_back(uint16_t(ray % each));
    ++out.start[ray / each + 1];
  }
  for (size_t p = 0; p < pixels.size(); ++p) out.start[p + 1] += out.start[p];
  return out;
}

// Pixels that the silhouette may pass through: not all of their own and their neighbors' samples meet the
// surface, nor do all miss it.
std::vector<uint32_t> on_silhouette(const PixelHits& view, int width, int height, int samples) {
  const uint32_t all = uint32_t(samples * samples);
  std::vector<uint32_t> out;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      bool hit = false, missed = false;
      for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
          const size_t p = size_t(v) * width + u;
          const uint32_t hits = view.start[p + 1] - view.start[p];
          hit |= hits > 0;
          missed |= hits < all;
        }
      if (hit && missed) out.push_back(uint32_t(y * width + x));
    }
  return out;
}

// Merges by pixel: those of `pixels` (ascending) are taken from `finer`.
PixelHits replaced(const PixelHits& view, std::span<const uint32_t> pixels, const PixelHits& finer) {
  PixelHits out;
  out.hits.reserve(view.hits.size() + finer.hits.size());
  out.start.push_back(0);
  size_t next = 0;
  for (size_t p = 0; p + 1 < view.start.size(); ++p) {
    const bool is_finer = next < pixels.size() && pixels[next] == p;
    const PixelHits& from = is_finer ? finer : view;
    const size_t at = is_finer ? next++ : p;
    out.hits.insert(out.hits.end(), from.hits.begin() + from.start[at],
                    from.hits.begin() + from.start[at + 1]);
    out.sub_pixels.insert(out.sub_pixels.end(), from.sub_pixels.begin() + from.start[at],
                          from.sub_pixels.begin() + from.start[at + 1]);
    out.start.push_back(uint32_t(out.hits.size()));
  }
  return out;
}

}  // namespace

GBuffer trace_view(const Device& device, const Scene& scene, const Camera& camera, int samples,
                   OnSurface on) {
  std::vector<uint32_t> pixels(size_t(camera.width) * camera.height);
  std::iota(pixels.begin(), pixels.end(), 0u);
  GBuffer g{
      camera.width, camera.height, std::vector<uint8_t>(pixels.size(), uint8_t(samples)), {}, {}, {}, {}};
  PixelHits view = trace_pixels(device, scene, camera, pixels, samples, on);
  if (samples > 1) {
    const std::vector<uint32_t> rim = on_silhouette(view, camera.width, camera.height, samples);
    view = replaced(view, rim, trace_pixels(device, scene, camera, rim, 2 * samples, on));
    for (const uint32_t p : rim) g.samples[p] = uint8_t(2 * samples);
  }
  const Vec3f forward = camera.forward(), center = to_float(camera.center);
  for (const Hit& h : view.hits) g.depths.push_back(dot(h.position - center, forward));
  g.hits = std::move(view.hits);
  g.sub_pixels = std::move(view.sub_pixels);
  g.pixel_start = std::move(view.start);
  return g;
}

}  // namespace cei3d
