// SPDX-License-Identifier: Apache-2.0
// Roughness from a number in [0, 1], such as the output of a network: 0 is kMinRoughness, and 1 is 1.
#pragma once

#include "core/math/brdf.h"

namespace cei3d {

inline constexpr float kRoughnessRange = 1 - kMinRoughness;  // derivative of roughness_of_share()

template <class T>
HD T roughness_of_share(T share) {
  return T(kMinRoughness) + T(kRoughnessRange) * share;
}
template <class T>
HD T share_of_roughness(T roughness) {
  return (roughness - T(kMinRoughness)) / T(kRoughnessRange);
}

}  // namespace cei3d
