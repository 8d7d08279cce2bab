// SPDX-License-Identifier: Apache-2.0
// Shares in [0, 1] as logits, on which descents are free.
#pragma once

#include <cmath>

#include "core/math/activation.h"

namespace cei3d {

inline float logit(float share) {
  constexpr float kMargin = 1e-3f;  // logits of 0 and 1 do not exist
  const float y = clamp(share, kMargin, 1 - kMargin);
  return std::log(y / (1 - y));
}
inline float share_of_logit(float logit) { return Sigmoid::eval(logit, 1).value; }

}  // namespace cei3d
