// SPDX-License-Identifier: Apache-2.0
// Numbers that grow by equal ratios.
#pragma once

#include <cmath>

#include "core/math/scalar.h"

namespace cei3d {

// Positive numbers from `low` to `high` of which equal steps have equal ratios.
struct GeometricLadder {
  float low, high;

  float at(float t) const { return low * std::pow(high / low, t); }  // t: 0 is low, 1 is high
  // Inverse of at(), in [0, 1].
  float place(float x) const { return clamp(std::log(x / low) / std::log(high / low), 0.0f, 1.0f); }
};

}  // namespace cei3d
