// SPDX-License-Identifier: Apache-2.0
// WebP files, by libwebp.
#pragma once

#include <string>

#include "core/image/image.h"

namespace cei3d {

// image: 3 channels, display-encoded; at most 16383 pixels a side. quality: 0 to 100; kLossless: as stored,
// in 8 bits.
inline constexpr int kLossless = -1;
std::string encode_webp(const Image& image, int quality);

// For tests. 3 channels, values as stored, /255. Errors: name `name`; not a whole WebP, or hardly more than
// one color.
Image decode_webp(const std::string& bytes, const std::string& name);

}  // namespace cei3d
