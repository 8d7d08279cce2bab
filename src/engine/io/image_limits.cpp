// SPDX-License-Identifier: Apache-2.0
#include "engine/io/image_limits.h"

#include "core/base/error.h"

namespace cei3d {

ImageSize readable_size(int64_t width, int64_t height, size_t bytes, const std::string& name) {
  if (width < 1 || height < 1 || width > kMaxImageSide || height > kMaxImageSide)
    fail("{} has an impossible size, {} x {} pixels. Copy or render it again.", name, width, height);
  const int64_t pixels = width * height;
  if (pixels > kMaxImagePixels)
    fail("{} has {} x {} pixels, more than the {} million that are read. Scale it down.", name, width, height,
         kMaxImagePixels / 1'000'000);
  if (size_t(pixels / kMaxPixelsPerByte) > bytes)
    fail("{} is broken: {} bytes are too few for {} x {} pixels. Copy or render it again.", name, bytes,
         width, height);
  return {int(width), int(height)};
}

}  // namespace cei3d
