// SPDX-License-Identifier: Apache-2.0
// Peak signal-to-noise ratio in display space, peak 1.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "core/image/image.h"

namespace cei3d {

// Composites over a gray background in the values' own space (display space, as the NeRF papers do). 4
// channels: straight alpha; 1 channel is repeated to three.
Image over_background(const Image& image, float background);

// a, b: RGB of one size, values in [0, 1], display-encoded. Infinity for equal images. Error: sizes differ.
double psnr(const Image& a, const Image& b);

// PSNR of the pixels with mask != 0; none if there are none. mask: [height][width].
std::optional<double> psnr_in_mask(const Image& a, const Image& b, std::span<const uint8_t> mask);

}  // namespace cei3d
