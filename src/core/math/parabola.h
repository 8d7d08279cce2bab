// SPDX-License-Identifier: Apache-2.0
// Extrema between equidistant values.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/math/scalar.h"

namespace cei3d {

// Where the parabola through three equidistant values is smallest, in steps from the middle one, which is not
// above the others: in [-0.5, 0.5]; 0 where all are equal.
inline double lowest_offset(double before, double middle, double after) {
  const double bend = before - 2 * middle + after;
  return bend > 0 ? clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

// The last place where that parabola is at most `rise` above its smallest value; at most one step away.
inline double last_offset_within(double before, double middle, double after, double rise) {
  const double bend = before - 2 * middle + after;
  return bend > 0 ? std::min(lowest_offset(before, middle, after) + std::sqrt(2 * rise / bend), 1.0) : 0;
}

}  // namespace cei3d
