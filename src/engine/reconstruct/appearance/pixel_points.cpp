// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/pixel_points.h"

#include <algorithm>
#include <cmath>

#include "core/math/tangents.h"

namespace cei3d {

std::array<Vec3f, kPixelPoints> pixel_points(const Hit& hit, float footprint) {
  const float spread = std::sqrt(1 / 6.0f) * footprint;  // standard deviation of the tent along an axis
  constexpr float kMinCosine = 0.25f;  // below it, the tangent plane is a poor approximation of the surface
  const Vec3f view = hit.to_camera;
  const auto [right, up] = tangents_of(view, 2);
  const float cosine = std::max(kMinCosine, dot(hit.normal, view));
  std::array<Vec3f, kPixelPoints> points;
  for (int k = 0; k < kPixelPoints; ++k) {
    const Vec3f across = (right * (k & 1 ? 1.0f : -1.0f) + up * (k & 2 ? 1.0f : -1.0f)) * spread;
    points[k] = hit.position + across - view * (dot(across, hit.normal) / cosine);
  }
  return points;
}

}  // namespace cei3d
