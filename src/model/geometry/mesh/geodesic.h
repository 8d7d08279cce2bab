// SPDX-License-Identifier: Apache-2.0
// Geodesic distances on a mesh.
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
  float farthest = kUnreached;                     // vertices farther away are not visited
  std::function<bool(uint32_t vertex)> may_enter;  // empty: every vertex; the source is always entered
};

// Length of the shortest path over the mesh from `source` to each vertex, kUnreached where there is none
// within the limits. A front unfolds one triangle after the other: exact on a plane, within one or two
// percent on curved surfaces (paths along edges alone are up to a tenth too long). [Kimmel and Sethian 1998;
// Novotni and Klein 2002]
std::vector<float> geodesic_distances(std::span<const Vec3f> positions,
                                      std::span<const std::array<uint32_t, 3>> triangles, uint32_t source,
                                      const GeodesicLimits& limits = {});

}  // namespace cei3d
