// SPDX-License-Identifier: Apache-2.0
// For tests: a box with a pit in its top, and pictures of it. No silhouette shows the pit, the colours do.
#pragma once

#include <cmath>

#include "engine/reconstruct/pixels.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

inline bool in_pit(Vec3f p) {
  return std::abs(p.x) < 0.28f && std::abs(p.y) < 0.28f && p.z > 0.1f && p.z < 0.4f;
}
// More than a cell of 0.05 from its walls.
inline bool amid_pit(Vec3f p) {
  return std::abs(p.x) < 0.22f && std::abs(p.y) < 0.22f && p.z > 0.16f && p.z < 0.4f;
}
inline bool in_solid(Vec3f p) {
  return std::abs(p.x) < 0.45f && std::abs(p.y) < 0.45f && std::abs(p.z) < 0.4f && !in_pit(p);
}

// Distance along the ray to the solid; 0: it misses.
inline float distance_to_solid(const Ray& ray) {
  for (float t = 1.5f; t < 4; t += 0.01f)
    if (in_solid(ray.origin + ray.direction * t)) return t;
  return 0;
}

// RGBA, linear. color_at: of a point on the surface.
template <class ColorAt>
Image box_picture(const Camera& camera, const ColorAt& color_at) {
  Image image(camera.width, camera.height, 4);
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      const float t = distance_to_solid(ray);
      if (t == 0) continue;
      const Vec3f c = color_at(ray.origin + ray.direction * t);
      float* out = image.at(x, y);
      out[0] = c.x, out[1] = c.y, out[2] = c.z, out[3] = 1;
    }
  return image;
}

// On a sphere of radius 2.5 around the origin, looking at it; `size` pixels an axis.
inline Camera box_camera(double height, double turn, int size) {
  const double flat = std::sqrt(1 - height * height);
  const Vec3d z{flat * std::cos(turn), flat * std::sin(turn), height};
  Camera c;
  c.width = c.height = size;
  c.fx = c.fy = 70 / 48.0 * size;
  c.cx = c.cy = 0.5 * size;
  c.center = z * 2.5;
  const Vec3d right = normalize(cross(Vec3d{0, 0, 1}, z)), down = cross(right, z);
  for (int k = 0; k < 3; ++k) c.world_from_cam.row[k] = {right[k], down[k], -z[k]};
  return c;
}

inline VisualHull hull_of(const PixelStore& pixels, int cells) {
  std::vector<HullMask> masks;
  for (size_t v = 0; v < pixels.cameras().size(); ++v)
    masks.push_back({pixels.cameras()[v], pixels.masks()[v]});
  return visual_hull(masks, cells);
}

// How much of the pit is open, and how much of the solid is gone: shares of the hull's cells there.
struct Opened {
  double pit, solid;
  int cells;  // of the pit
};

inline Opened opened_of(const VisualHull& hull, const VisualHull& carved) {
  int pit = 0, opened = 0, solid = 0, lost = 0;
  for (size_t i = 0; i < hull.inside.size(); ++i) {
    const size_t n = size_t(hull.n);
    const auto at = [&](size_t k) { return (float(k) + 0.5f) * 2 / float(n) - 1; };
    const Vec3f p{at(i % n), at(i / n % n), at(i / (n * n))};
    if (!hull.inside[i]) continue;
    if (amid_pit(p)) ++pit, opened += !carved.inside[i];
    if (in_solid(p)) ++solid, lost += !carved.inside[i];
  }
  return {double(opened) / pit, double(lost) / solid, pit};
}

}  // namespace cei3d
