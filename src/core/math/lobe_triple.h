// SPDX-License-Identifier: Apache-2.0
// A stretched reflection lobe as the mean of three round ones in the plane of incidence, as wide as it is
// across that plane: one about its axis, and two at an angle to both sides. Angle and weights are those of
// Gauss-Hermite quadrature for the variance that its peak has more along the plane. (That of the whole lobe,
// three times as large because of its tails, would move the outer lobes out of the peak.)
#pragma once

#include <cmath>

#include "core/math/reflection.h"

namespace cei3d {

// Weight of the lobe about the axis; the others share the rest.
inline constexpr float kMiddleShare = 2.0f / 3;

struct LobeTriple {
  float roughness;  // of each; the variance of a lobe grows with roughness^4
  float angle;      // radians
};

// See stretched_lobe().
inline LobeTriple lobe_triple(float roughness, float stretch) {
  constexpr float kMaxAngle = 1.2f;
  const float variance = reflection_peak_width(roughness) * (stretch - 1 / stretch);
  return {roughness / std::sqrt(std::sqrt(stretch)), min(std::sqrt(3 * variance), kMaxAngle)};
}

}  // namespace cei3d
