// SPDX-License-Identifier: Apache-2.0
// What sticks out of values that should change smoothly with direction.
#pragma once

#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

// Each value minus what the values in nearby directions make of it: a linear function of the direction fitted
// to the ten nearest, of which some may be wrong. A direction at the edge of all others is judged by a
// function that is continued, not fitted, there: its difference counts less, by the standard deviation of the
// two. directions: of length 1. Fewer than three others: 0.
std::vector<double> against_nearby(std::span<const Vec3d> directions, std::span<const double> values);

}  // namespace cei3d
