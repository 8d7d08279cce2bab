// SPDX-License-Identifier: Apache-2.0
// OpenEXR files, read and written by the OpenEXR library.
#pragma once

#include <string>

#include "core/image/image.h"
#include "engine/io/image_size.h"

namespace cei3d {

// Float values as stored, linear. Channels: R, G, B (and A): 3 or 4; else Y or the only channel: 1. The image
// is the display window; pixels outside the data window are zero. Errors name `name`.
Image decode_exr(const std::string& bytes, const std::string& name);
ImageSize exr_size(const std::string& bytes, const std::string& name);

// 1, 3 or 4 channels as 32-bit float Y or RGB(A), ZIP-compressed.
std::string encode_exr(const Image& image);

}  // namespace cei3d
