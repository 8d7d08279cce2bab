// SPDX-License-Identifier: Apache-2.0
// For tests: a box with a pit in its top, and pictures of it. No silhouette shows the pit, the colors do.
#pragma once

#include <cmath>

#include "core/image/resample.h"
#include "engine/reconstruct/pixels.h"
#include "engine/synthetic/picture.h"
#include "engine/synthetic/views.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

// Whether a point is in the pit, more than a cell of 0.05 from its walls.
inline bool amid_pit(Vec3f p) {
  return std::abs(p.x) < 0.22f && std::abs(p.y) < 0.22f && p.z > 0.16f && p.z < 0.4f;
}
struct PitBoxDistance {
  template <class T>
  T operator()(Vec3<T> p) const {
    const BoxDistance solid{{0.45f, 0.45f, 0.4f}, 0}, pit{{0.28f, 0.28f, 0.25f}, 0};
    return max(solid(p), -pit(Vec3<T>{p.x, p.y, p.z - T(0.35f)}));
  }
};
inline const Body& pit_box() {
  static const SdfBody<PitBoxDistance> body{PitBoxDistance()};
  return body;
}
inline bool in_solid(Vec3f p) { return pit_box().distance(p) < 0; }

// RGBA, linear. color_at: of a point just below the surface.
template <class ColorAt>
Image box_picture(const Camera& camera, const ColorAt& color_at) {
  return draw_unlit(pit_box(), camera, [&](Vec3f p) { return color_at(p - pit_box().normal(p) * 2e-3f); });
}

// Pixels are means, as those of a photograph.
template <class ColorAt>
Image filtered_box_picture(const Camera& camera, const ColorAt& color_at) {
  constexpr int kSamples = 4;  // per pixel and axis
  Camera finer = camera;
  finer.width *= kSamples;
  finer.height *= kSamples;
  for (double* f : {&finer.fx, &finer.fy, &finer.cx, &finer.cy, &finer.skew}) *f *= kSamples;
  return downscale(box_picture(finer, color_at), kSamples);
}

// A camera 2.5 from the origin, looking at it; `size` pixels per axis.
inline Camera box_camera(double height, double turn, int size) {
  const double flat = std::sqrt(1 - height * height);
  return look_at(Vec3d{flat * std::cos(turn), flat * std::sin(turn), height} * 2.5, {0, 0, 0},
                 {size, size, 70 / 48.0 * size});
}

inline VisualHull hull_of(const PixelStore& pixels, int cells) {
  std::vector<HullMask> masks;
  for (size_t v = 0; v < pixels.cameras().size(); ++v)
    masks.push_back({pixels.cameras()[v], pixels.masks()[v]});
  return visual_hull(masks, cells);
}

// What carving has removed from a hull.
struct Opened {
  double pit;    // share of the pit's cells that are open
  double solid;  // share of the solid's cells that are gone
  int cells;     // number of the pit's cells
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
