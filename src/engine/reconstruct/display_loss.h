// SPDX-License-Identifier: Apache-2.0
// What the appearance stage minimises: the Huber loss of display-encoded colours.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/color.h"
#include "core/math/loss.h"

namespace cei3d {

// Its slope by `got`; both linear. The sRGB curve's own slope is bounded where it is steep.
inline float display_loss_slope(float got, float want) {
  const float error = srgb_from_linear(std::max(got, 0.0f)) - srgb_from_linear(want);
  return huber(error, 0.05f).gradient * 1.055f / 2.4f * std::pow(std::max(got, 0.004f), 1 / 2.4f - 1);
}

}  // namespace cei3d
