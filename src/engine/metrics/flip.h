// SPDX-License-Identifier: Apache-2.0
// LDR-FLIP: the difference that a person sees who alternates between two images. [Andersson et al. 2020]
#pragma once

#include <optional>

#include "core/image/area.h"
#include "core/image/image.h"

namespace cei3d {

// Viewing conditions of Andersson et al.: 0.7 m before a display of 3840 pixels and 0.7 m.
inline constexpr double kFlipPixelsPerDegree = 0.7 * 3840 / 0.7 * 3.14159265358979 / 180;

// Error of each pixel, [0, 1], 0: no difference can be seen. reference, test: RGB of one size, sRGB-encoded,
// [0, 1]. Error: sizes differ.
Image flip_map(const Image& reference, const Image& test, double pixels_per_degree = kFlipPixelsPerDegree);

// Means of the map: over the image; over the area, none if it is empty.
double flip(const Image& reference, const Image& test);
std::optional<double> flip_in_area(const Image& reference, const Image& test, const Area& area);

}  // namespace cei3d
