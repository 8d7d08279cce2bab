// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/part_pattern.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/math/rng.h"
#include "engine/edit/albedo_branch.h"
#include "model/scene/parts.h"

namespace cei3d {
namespace {

constexpr double kSamplesPerPixel = 2;  // samples of the surface per pixel of the tile
constexpr size_t kMinSamples = 20000, kMaxSamples = 300000;
constexpr uint64_t kSeed = 1;

// Index into n tiles' pixels, mirrored at each repetition.
int mirrored(double at, int n) {
  const auto i = int(std::floor(at)), period = 2 * n;
  const int k = ((i % period) + period) % period;
  return k < n ? k : period - 1 - k;
}

// Points spread evenly over the triangles of a mesh whose middles lie in the part.
struct SurfacePoints {
  std::vector<Vec3f> positions, normals;
};

std::vector<uint32_t> triangles_inside(const Scene& scene, const EditLayer& part) {
  const Mesh& mesh = scene.surface->mesh();
  std::vector<Hit> middles(mesh.triangles.size());
  constexpr float kThird = 1.0f / 3;
  for (size_t t = 0; t < middles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    const Vec3f n = normalize(at_corners(mesh.normals, corners, kThird, kThird));
    middles[t] = {at_corners(mesh.positions, corners, kThird, kThird), n, n, uint32_t(t), kThird, kThird};
  }
  const std::vector<uint8_t> inside = inside_layer(scene, part, middles);
  std::vector<uint32_t> ids;
  for (uint32_t t = 0; t < inside.size(); ++t)
    if (inside[t]) ids.push_back(t);
  return ids;
}

SurfacePoints spread_over(const Mesh& mesh, std::span<const uint32_t> triangles, float pixel) {
  std::vector<double> area_up_to{0};
  for (const uint32_t t : triangles)
    area_up_to.push_back(area_up_to.back() + triangle_area(mesh, mesh.triangles[t]));
  const double wanted = kSamplesPerPixel * area_up_to.back() / square(double(pixel));
  const size_t n = std::clamp(size_t(wanted), kMinSamples, kMaxSamples);
  SurfacePoints points;
  for (size_t i = 0, k = 0; i < n; ++i) {
    const double area = (double(i) + 0.5) / double(n) * area_up_to.back();
    while (k + 1 < triangles.size() && area_up_to[k + 1] < area) ++k;
    Rng rng(kSeed, 0, i);
    float u = rng.uniform(), v = rng.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto& corners = mesh.triangles[triangles[k]];
    points.positions.push_back(at_corners(mesh.positions, corners, u, v));
    points.normals.push_back(normalize(at_corners(mesh.normals, corners, u, v)));
  }
  return points;
}

}  // namespace

PartPattern::PartPattern(const PartScribble& scribble, const Camera& camera, double depth)
    : scribble_(scribble), camera_(camera), depth_(depth), pixel_(depth / camera.fx) {}

Vec3f PartPattern::at(Vec3f position, Vec3f normal) const {
  const Vec3d in_image = camera_.project(to_double(position));
  const Vec3d n = transpose(camera_.world_from_cam) * to_double(normal);
  const double behind = (in_image.z - depth_) / pixel_;  // pixels
  double u = in_image.x, v = in_image.y;
  if (std::abs(n.x) > std::abs(n.z) && std::abs(n.x) >= std::abs(n.y)) u = behind;
  if (std::abs(n.y) > std::abs(n.z) && std::abs(n.y) > std::abs(n.x)) v = behind;
  const Image& tile = scribble_.tile;
  return tile.rgb(mirrored(u - scribble_.x0, tile.width), mirrored(v - scribble_.y0, tile.height));
}

std::shared_ptr<const Field> fit_pattern(const Device& device, const Scene& scene, const EditLayer& part,
                                         const PartPattern& pattern, Progress& progress) {
  const std::vector<uint32_t> triangles = triangles_inside(scene, part);
  if (triangles.empty()) fail("Part '{}' is smaller than a triangle of the surface; select more.", part.part);
  SurfacePoints points = spread_over(scene.surface->mesh(), triangles, pattern.pixel());
  BranchSamples samples;
  for (size_t i = 0; i < points.positions.size(); ++i)
    samples.targets.push_back(pattern.at(points.positions[i], points.normals[i]));
  samples.positions = std::move(points.positions);
  samples.pixel = pattern.pixel();
  return fit_branch(device, samples, {}, kSeed, progress);
}

}  // namespace cei3d
