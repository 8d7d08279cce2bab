// SPDX-License-Identifier: Apache-2.0
// Real spherical harmonics up to the third band, orthonormal over the sphere.
#pragma once

#include <array>
#include <cstddef>

#include "core/math/vec.h"

namespace cei3d {

constexpr size_t kHarmonics = 16;
using Harmonics = std::array<float, kHarmonics>;

// At a unit direction. [Ramamoorthi and Hanrahan 2001] has the first three bands.
inline Harmonics harmonics(Vec3f d) {
  const float x = d.x, y = d.y, z = d.z;
  return {0.282095f,
          0.488603f * y,
          0.488603f * z,
          0.488603f * x,
          1.092548f * x * y,
          1.092548f * y * z,
          0.315392f * (3 * z * z - 1),
          1.092548f * x * z,
          0.546274f * (x * x - y * y),
          0.590044f * y * (3 * x * x - y * y),
          2.890611f * x * y * z,
          0.457046f * y * (5 * z * z - 1),
          0.373176f * z * (5 * z * z - 3),
          0.457046f * x * (5 * z * z - 1),
          1.445306f * z * (x * x - y * y),
          0.590044f * x * (x * x - 3 * y * y)};
}

}  // namespace cei3d
