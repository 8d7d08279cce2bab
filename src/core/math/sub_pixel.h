// SPDX-License-Identifier: Apache-2.0
// Where the rays of a pixel go, and what they count for in a picture.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/vec.h"

namespace cei3d {

// Sample k of the samples^2 on a grid in a pixel, [0, 1)^2.
inline Vec2f sub_pixel(int k, int samples) {
  return {(float(k % samples) + 0.5f) / float(samples), (float(k / samples) + 0.5f) / float(samples)};
}

// Weight of a sample for the pixel whose middle is so far away, in pixels: a tent along either axis.
inline float tent_weight(Vec2f away) {
  const auto tent = [](float d) { return std::max(0.0f, 1 - std::abs(d)); };
  return tent(away.x) * tent(away.y);
}

}  // namespace cei3d
