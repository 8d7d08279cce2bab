// SPDX-License-Identifier: Apache-2.0
// Positions of a pixel's samples and their weights in the image.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/vec.h"

namespace cei3d {

// Position in the pixel, [0, 1)^2, of sample k of a samples x samples grid.
inline Vec2f sub_pixel(int k, int samples) {
  return {(float(k % samples) + 0.5f) / float(samples), (float(k / samples) + 0.5f) / float(samples)};
}

// Weight of a sample at an offset (pixels) from a pixel's center: a tent along either axis.
inline float tent_weight(Vec2f away) {
  const auto tent = [](float d) { return std::max(0.0f, 1 - std::abs(d)); };
  return tent(away.x) * tent(away.y);
}

}  // namespace cei3d
