// SPDX-License-Identifier: Apache-2.0
// OpenEXR, by its library (the only file that knows it).
#pragma once

#include <string>

#include "core/image/image.h"
#include "engine/io/image_size.h"

namespace cei3d {

// Float as stored, linear. Channels: R, G, B (and A): 3 or 4; else Y or the only channel there is: 1. The
// picture is the display window; what the data window leaves out is zero. Errors name `name`.
Image decode_exr(const std::string& bytes, const std::string& name);
ImageSize exr_size(const std::string& bytes, const std::string& name);

// 1, 3 or 4 channels as 32-bit float Y or RGB(A), ZIP-compressed.
std::string encode_exr(const Image& image);

}  // namespace cei3d
