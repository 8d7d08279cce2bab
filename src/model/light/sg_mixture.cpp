// SPDX-License-Identifier: Apache-2.0
#include "model/light/sg_mixture.h"

#include <cmath>

#include "core/base/error.h"

namespace cei3d {

Vec3f radiance(const SgMixture& light, Vec3f direction) {
  Vec3f sum{0, 0, 0};
  for (const SgLobe& l : light.lobes) sum += l.mu * std::exp(l.lambda * (dot(direction, l.axis) - 1));
  return sum;
}

SgMixture rotated(SgMixture light, const Mat3f& rotation) {
  for (SgLobe& l : light.lobes) l.axis = normalize(rotation * l.axis);
  return light;
}

SgMixture scaled(SgMixture light, Vec3f factor) {
  for (SgLobe& l : light.lobes) l.mu = l.mu * factor;
  return light;
}

std::vector<float> to_array(const SgMixture& light) {
  std::vector<float> rows;
  rows.reserve(7 * light.lobes.size());
  for (const SgLobe& l : light.lobes)
    rows.insert(rows.end(), {l.axis.x, l.axis.y, l.axis.z, l.lambda, l.mu.x, l.mu.y, l.mu.z});
  return rows;
}

SgMixture light_from_array(std::span<const float> rows) {
  if (rows.empty() || rows.size() % 7)
    fail("The {} numbers of a light are no rows of 7 (axis, sharpness, color).", rows.size());
  for (const float x : rows)
    if (!std::isfinite(x)) fail("A number of the light is not finite.");
  SgMixture light;
  for (size_t i = 0; i < rows.size(); i += 7) {
    const Vec3f axis{rows[i], rows[i + 1], rows[i + 2]};
    if (length(axis) < 1e-6f) fail("Lobe {} of the light has no direction.", i / 7);
    light.lobes.push_back({normalize(axis),
                           clamp(std::abs(rows[i + 3]), kBroadestLobe, kSharpestLobe),
                           {std::abs(rows[i + 4]), std::abs(rows[i + 5]), std::abs(rows[i + 6])}});
  }
  return light;
}

}  // namespace cei3d
