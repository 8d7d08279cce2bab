// SPDX-License-Identifier: Apache-2.0
// Radiance files (.hdr): RGB with a shared exponent. [Ward 1991; Radiance file formats]
#pragma once

#include <string>

#include "core/image/image.h"
#include "engine/io/image_size.h"

namespace cei3d {

// 3 channels, linear; EXPOSURE lines are divided out. Reads flat, old and new run-length scanlines, rows from
// the top only. Errors name `name`.
Image decode_hdr(const std::string& bytes, const std::string& name);
ImageSize hdr_size(const std::string& bytes, const std::string& name);

// image: 3 channels (a 4th is dropped), linear, negative values become 0. Relative error up to 1/256 of the
// largest channel.
std::string encode_hdr(const Image& image);

}  // namespace cei3d
