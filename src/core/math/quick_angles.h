// SPDX-License-Identifier: Apache-2.0
// Angles by short polynomials [Abramowitz and Stegun 1964, 4.4.45, 4.4.48], in radians, for lookups in light
// that need no more: faster than those of the standard library.
#pragma once

#include <cmath>

#include "core/math/scalar.h"

namespace cei3d {

// Within 7e-5 of acos(x); x in [-1, 1].
inline float quick_acos(float x) {
  const float a = std::fabs(x);
  const float angle =
      std::sqrt(max(1 - a, 0.0f)) * (1.5707288f + a * (-0.2121144f + a * (0.0742610f - 0.0187293f * a)));
  return x < 0 ? kPi - angle : angle;
}

// Within 2e-5 of atan2(y, x); 0 at the origin.
inline float quick_atan2(float y, float x) {
  const float a = std::fabs(x), b = std::fabs(y), large = max(a, b), t = large > 0 ? min(a, b) / large : 0.0f,
              u = t * t;
  float angle = t * (0.9998660f + u * (-0.3302995f + u * (0.1801410f + u * (-0.0851330f + 0.0208351f * u))));
  if (b > a) angle = kPi / 2 - angle;
  if (x < 0) angle = kPi - angle;
  return y < 0 ? -angle : angle;
}

}  // namespace cei3d
