// SPDX-License-Identifier: Apache-2.0
// Points on the surface that represent a pixel. A pixel is a mean over its filter: a texture that is fitted
// at pixel centers alone comes out blurred by the filter.
#pragma once

#include <array>

#include "model/geometry/shape/hit.h"

namespace cei3d {

inline constexpr int kPixelPoints = 4;

// Four points on the tangent plane of the hit at the pixel's center, with the spread of the pixel filter, a
// tent of radius one pixel (engine/render/render.h). footprint: distance between neighboring pixels
// perpendicular to the line of sight, unit frame.
std::array<Vec3f, kPixelPoints> pixel_points(const Hit& hit, float footprint);

}  // namespace cei3d
