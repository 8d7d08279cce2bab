// SPDX-License-Identifier: Apache-2.0
// Area and convex hull of flat pieces.
#pragma once

#include <vector>

#include "core/math/vec2.h"
#include "model/geometry/unwrap/pack.h"

namespace cei3d {

// The convex hull, counter-clockwise. [Andrew 1979]
std::vector<Vec2d> convex_hull(std::vector<Vec2d> points);

double area_of(const FlatPiece&);

// The share of its convex hull that a piece covers.
double fullness(const FlatPiece&);

}  // namespace cei3d
