// SPDX-License-Identifier: Apache-2.0
// TIFF files, by libtiff.
#pragma once

#include <string>

#include "core/image/image.h"
#include "engine/io/image_size.h"

namespace cei3d {

ImageSize tiff_size(const std::string& bytes, const std::string& name);
// Bits of a channel: 8, 16, or 32 of floating point.
int tiff_bits(const std::string& bytes, const std::string& name);

// The ICC profile; empty if there is none.
std::string tiff_profile(const std::string& bytes, const std::string& name);

struct TiffImage {
  Image image;          // 1, 3 or 4 channels, values as stored, /255 or /65535; straight alpha
  bool linear = false;  // floating-point values, which are linear
  std::string profile;  // tiff_profile()
};
// Strips of 8- or 16-bit integers or 32-bit floating-point numbers, channels interleaved. Errors name `name`:
// truncated, corrupt, another layout.
TiffImage decode_tiff(const std::string& bytes, const std::string& name);

// For tests: 16-bit, not compressed. image: 1, 3 or 4 channels.
std::string encode_tiff(const Image& image);

}  // namespace cei3d
