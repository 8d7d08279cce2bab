// SPDX-License-Identifier: Apache-2.0
// What the appearance stage minimises: the Huber loss of display-encoded colours.
#pragma once

#include <algorithm>

#include "core/math/color.h"
#include "core/math/loss.h"

namespace cei3d {

// Its slope by `got`; both linear. The display curve is not followed where it is steepest. clipped: the
// picture shows no more than that it is at least `want`.
inline float display_loss_slope(float got, float want, bool clipped = false) {
  if (clipped && got >= want) return 0;
  const float error = srgb_from_linear(std::max(got, 0.0f)) - srgb_from_linear(want);
  return huber(error, 0.05f).gradient * srgb_slope(std::max(got, 0.004f));
}

}  // namespace cei3d
