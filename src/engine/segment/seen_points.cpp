// SPDX-License-Identifier: Apache-2.0
#include "engine/segment/seen_points.h"

#include <algorithm>

#include "core/math/bilinear.h"

namespace cei3d {
namespace {

std::vector<SeenPoint> facing_points(const Camera& camera, std::span<const Vec3f> positions,
                                     std::span<const Vec3f> normals, float min_facing) {
  std::vector<SeenPoint> facing;
  const Vec3f eye = to_float(camera.center);
  for (size_t i = 0; i < positions.size(); ++i) {
    const float cosine = dot(normals[i], normalize(eye - positions[i]));
    if (cosine < min_facing) continue;
    const Vec3d p = camera.project(to_double(positions[i]));
    if (p.z <= 0 || p.x < 0 || p.y < 0 || p.x >= camera.width || p.y >= camera.height) continue;
    facing.push_back({uint32_t(i), {float(p.x), float(p.y)}, cosine});
  }
  return facing;
}

}  // namespace

std::vector<SeenPoint> seen_points(const Surface& surface, const Camera& camera,
                                   std::span<const Vec3f> positions, std::span<const Vec3f> normals,
                                   float min_facing, float tolerance) {
  std::vector<SeenPoint> seen = facing_points(camera, positions, normals, min_facing);
  const Vec3f eye = to_float(camera.center);
  std::vector<Vec3f> origins(seen.size(), eye), directions(seen.size());
  for (size_t i = 0; i < seen.size(); ++i) directions[i] = normalize(positions[seen[i].point] - eye);
  std::vector<Surface::RayHit> hits(seen.size());
  surface.intersect(origins, directions, 0, hits);
  size_t kept = 0;
  for (size_t i = 0; i < seen.size(); ++i)
    if (hits[i].t < 0 || hits[i].t > length(positions[seen[i].point] - eye) - tolerance)
      seen[kept++] = seen[i];
  seen.resize(kept);
  return seen;
}

float sample(const Image& image, Vec2f pixel) {
  const float u = clamp(pixel.x - 0.5f, 0.0f, float(image.width - 1));
  const float v = clamp(pixel.y - 0.5f, 0.0f, float(image.height - 1));
  const int x = std::min(int(u), std::max(image.width - 2, 0)),
            y = std::min(int(v), std::max(image.height - 2, 0));
  const int x1 = std::min(x + 1, image.width - 1), y1 = std::min(y + 1, image.height - 1);
  const float fu = u - float(x), fv = v - float(y);
  return bilinear({*image.at(x, y), *image.at(x1, y), *image.at(x, y1), *image.at(x1, y1)}, fu, fv);
}

}  // namespace cei3d
