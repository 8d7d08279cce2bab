// SPDX-License-Identifier: Apache-2.0
// A stretched reflection lobe as the mean of round ones in the plane of incidence, as wide as it is across
// that plane: one about its axis, and others at equal angles to both sides. Angles and weights give the row
// the variance that the lobe's peak has more along the plane. (That of the whole lobe, three times as large
// because of its tails, would move the outer lobes out of the peak.)
#pragma once

#include <cmath>

#include "core/math/reflection.h"

namespace cei3d {

// Three, with the nodes and weights of Gauss-Hermite quadrature: neighbors are 1.7 standard deviations apart,
// and leave gaps between them if the lobe is much longer than wide. The middle one has this weight, the
// others share the rest.
inline constexpr float kMiddleShare = 2.0f / 3;
inline constexpr float kMaxTripleStretch = 1.8f;

// Five, with binomial weights: neighbors are one standard deviation apart.
inline constexpr int kRowLobes = 5;
inline constexpr float kRowShares[kRowLobes] = {1.0f / 16, 4.0f / 16, 6.0f / 16, 4.0f / 16, 1.0f / 16};
inline constexpr float kMaxRowStretch = 2.5f;

struct LobeRow {
  float roughness;  // of each; the variance of a lobe grows with roughness^4
  float angle;      // radians, between neighbors
};

// stretch: see stretched_lobe(). deviations: standard deviations of the row between its neighbors.
inline LobeRow lobe_row(float roughness, float stretch, float deviations, float max_angle) {
  const float variance = reflection_peak_width(roughness) * (stretch - 1 / stretch);
  return {roughness / std::sqrt(std::sqrt(stretch)), min(deviations * std::sqrt(variance), max_angle)};
}
inline LobeRow lobe_triple(float roughness, float stretch) {
  return lobe_row(roughness, min(stretch, kMaxTripleStretch), std::sqrt(3.0f), 1.2f);
}
inline LobeRow lobe_row(float roughness, float stretch) {
  return lobe_row(roughness, min(stretch, kMaxRowStretch), 1, 0.6f);
}

}  // namespace cei3d
