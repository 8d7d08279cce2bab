// SPDX-License-Identifier: Apache-2.0
// Interpolation between the cell centers of a grid over [-1, 1]^3.
#pragma once

#include <cstddef>

#include "core/math/vec.h"

namespace cei3d {

// value_at(x, y, z): value of a cell, indices in [0, n). Positions beyond the outermost centers are clamped.
template <class ValueAt>
float trilinear(Vec3f p, int n, const ValueAt& value_at) {
  float f[3];
  int i[3];
  for (int c = 0; c < 3; ++c) {
    const float t = clamp((p[c] + 1) * 0.5f * float(n) - 0.5f, 0.0f, float(n) - 1.001f);
    i[c] = int(t);
    f[c] = t - float(i[c]);
  }
  const auto row = [&](int y, int z) {
    const float a = value_at(i[0], y, z), b = value_at(i[0] + 1, y, z);
    return a + f[0] * (b - a);
  };
  const auto layer = [&](int z) {
    const float a = row(i[1], z), b = row(i[1] + 1, z);
    return a + f[1] * (b - a);
  };
  const float a = layer(i[2]), b = layer(i[2] + 1);
  return a + f[2] * (b - a);
}

}  // namespace cei3d
