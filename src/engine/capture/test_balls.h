// SPDX-License-Identifier: Apache-2.0
// Exact masks of objects made of balls.
#pragma once

#include <span>

#include "core/image/area.h"
#include "core/math/camera.h"
#include "core/math/ray_sphere.h"

namespace cei3d {

struct Ball {  // unit frame
  Vec3d center;
  double radius;
};

inline Area seen_balls(std::span<const Ball> balls, const Camera& camera) {
  Area out(size_t(camera.width) * size_t(camera.height));
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      for (const Ball& b : balls) {
        const auto [near, far] =
            sphere_span(to_double(ray.origin) - b.center, to_double(ray.direction), b.radius);
        out[size_t(y) * size_t(camera.width) + size_t(x)] |= near < far;
      }
    }
  return out;
}

// The share of `whole` that is in `part`.
inline double share_of(const Area& part, const Area& whole) {
  size_t both = 0;
  for (size_t i = 0; i < part.size(); ++i) both += part[i] && whole[i];
  return double(both) / double(pixels_in(whole));
}

}  // namespace cei3d
