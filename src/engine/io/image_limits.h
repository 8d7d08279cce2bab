// SPDX-License-Identifier: Apache-2.0
// The bound of every reader of images: checked before memory for pixels is taken.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "engine/io/image_size.h"

namespace cei3d {

inline constexpr int kMaxImageSide = 65535;
inline constexpr int64_t kMaxImagePixels = int64_t(1) << 28;  // 4 GB as four floats; cameras have up to 2e8
// Deflate makes at most 1032 bytes of one, each eight pixels of one bit. The other formats say less about
// photographs.
inline constexpr int64_t kMaxPixelsPerByte = 8 * 1032;

// The size that the header of a file of `bytes` bytes states. Error: names `name`, the size is beyond these
// bounds.
ImageSize readable_size(int64_t width, int64_t height, size_t bytes, const std::string& name);

}  // namespace cei3d
