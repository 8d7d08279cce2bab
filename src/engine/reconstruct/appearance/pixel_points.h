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

// For the outputs [begin, end) of a field of colors at the points of pixels, one pixel after the other: calls
// use(pixel, its mean color, dL/d(mean color) to set). out, d_out: of FieldTrainer::Loss.
template <class Use>
void for_each_pixel(int begin, int end, const float* out, float* d_out, const Use& use) {
  for (int first = begin; first < end; first += kPixelPoints) {
    Vec3f mean{0, 0, 0}, d_mean{0, 0, 0};
    const float* points = out + 3 * (first - begin);
    for (int k = 0; k < kPixelPoints; ++k)
      for (int c = 0; c < 3; ++c) mean[c] += points[3 * k + c] / kPixelPoints;
    use(first / kPixelPoints, mean, d_mean);
    for (int k = 0; k < kPixelPoints; ++k)
      for (int c = 0; c < 3; ++c) d_out[3 * (first - begin + k) + c] = d_mean[c] / kPixelPoints;
  }
}

}  // namespace cei3d
