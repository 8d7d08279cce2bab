// SPDX-License-Identifier: Apache-2.0
// Lengths of ways along a surface.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

inline constexpr float kUnreached = std::numeric_limits<float>::infinity();

struct GeodesicLimits {
  float farthest = kUnreached;                     // vertices beyond are not visited
  std::function<bool(uint32_t vertex)> may_enter;  // empty: every vertex; the source is always entered
};

// For every vertex the length of the shortest way from `source` over the mesh, kUnreached where there is none
// within the limits. By a front that unfolds one triangle after the other: exact on a plane, within a percent
// or two on curved surfaces (over edges alone it is up to a tenth too long). [Kimmel and Sethian 1998;
// Novotni and Klein 2002]
std::vector<float> geodesic_distances(std::span<const Vec3f> positions,
                                      std::span<const std::array<uint32_t, 3>> triangles, uint32_t source,
                                      const GeodesicLimits& limits = {});

}  // namespace cei3d
