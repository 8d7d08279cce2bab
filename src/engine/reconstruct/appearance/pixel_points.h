// SPDX-License-Identifier: Apache-2.0
// Points that stand for a pixel where it meets the surface. A pixel is a mean: a texture that has to match it
// at its center alone learns the picture blurred once more by every pixel's filter.
#pragma once

#include <array>

#include "model/geometry/shape/hit.h"

namespace cei3d {

inline constexpr int kPixelPoints = 4;

// On the tangent plane of a hit in the pixel's middle, with the spread of the pixel's filter, a tent of
// radius one pixel (engine/render/render.h). footprint: distance between neighboring pixels across the line
// of sight.
std::array<Vec3f, kPixelPoints> pixel_points(const Hit& hit, float footprint);

}  // namespace cei3d
