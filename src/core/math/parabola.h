// SPDX-License-Identifier: Apache-2.0
// Extrema between equidistant values.
#pragma once

#include "core/math/scalar.h"

namespace cei3d {

// Where the parabola through three equidistant values is smallest, in steps from the middle one, which is not
// above the others: in [-0.5, 0.5]; 0 where all are equal.
inline double lowest_offset(double before, double middle, double after) {
  const double bend = before - 2 * middle + after;
  return bend > 0 ? clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0;
}

}  // namespace cei3d
