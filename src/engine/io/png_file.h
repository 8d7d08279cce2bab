// SPDX-License-Identifier: Apache-2.0
// PNG files, by libpng.
#pragma once

#include <optional>
#include <string>

#include "core/image/image.h"

namespace cei3d {

// Values as stored, /255 or /65535. Channels: 1 (gray), 3 or 4; palettes, few bits and gray with alpha are
// expanded. Errors name `name`: truncated, corrupt, larger than 65,535 pixels per side.
Image decode_png(const std::string& bytes, const std::string& name);

// The ICC profile in the file; empty if there is none, or a damaged one.
std::string png_profile(const std::string& bytes, const std::string& name);
bool png_has_profile(const std::string& bytes);  // also a damaged one
// The exponent by which values were stored (gAMA; 1: linear). None where the file does not say so, is said to
// be sRGB, or has about 1 / 2.2, by which programs mean sRGB.
std::optional<double> png_gamma(const std::string& bytes, const std::string& name);

// image: 1, 3 or 4 channels, values as they are stored in the file (display-encoded for color), clamped to
// [0, 1] and rounded; NaN becomes 0. bits: 8 or 16.
std::string encode_png(const Image& image, int bits);

}  // namespace cei3d
