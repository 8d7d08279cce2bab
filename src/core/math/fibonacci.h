// SPDX-License-Identifier: Apache-2.0
// Nearly uniform directions: a spiral over the sphere whose points are a golden angle apart in azimuth.
#pragma once

#include <cmath>
#include <numbers>

#include "core/math/vec.h"

namespace cei3d {

inline constexpr double kGoldenAngle =
    std::numbers::pi * (3 - 2.2360679774997896964);  // radians; pi (3 - sqrt 5)

// Unit direction i of n; i in [0, n), from +Z to -Z.
inline Vec3f fibonacci_direction(int i, int n, double golden_angle = kGoldenAngle) {
  const double z = 1 - (2 * i + 1.0) / n, r = std::sqrt(1 - z * z), a = golden_angle * i;
  return {float(r * std::cos(a)), float(r * std::sin(a)), float(z)};
}

}  // namespace cei3d
