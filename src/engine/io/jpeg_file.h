// SPDX-License-Identifier: Apache-2.0
// JPEG files, by libjpeg-turbo.
#pragma once

#include <string>

#include "core/image/image.h"
#include "engine/io/image_size.h"

namespace cei3d {

ImageSize jpeg_size(const std::string& bytes, const std::string& name);

// 3 channels, values as stored, /255. Errors name `name`: truncated, corrupt, CMYK.
Image decode_jpeg(const std::string& bytes, const std::string& name);

// For tests and previews. image: 3 channels, display-encoded.
std::string encode_jpeg(const Image& image, int quality);

}  // namespace cei3d
