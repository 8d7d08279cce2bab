// SPDX-License-Identifier: Apache-2.0
#include "engine/io/webp_file.h"

#include <webp/decode.h>
#include <webp/encode.h>

#include <algorithm>
#include <cstdint>
#include <memory>

#include "core/base/error.h"
#include "engine/io/image_limits.h"

namespace cei3d {
namespace {

struct Free {
  void operator()(uint8_t* data) const { WebPFree(data); }
};
using Bytes = std::unique_ptr<uint8_t, Free>;

const uint8_t* data_of(const std::string& bytes) { return reinterpret_cast<const uint8_t*>(bytes.data()); }

}  // namespace

std::string encode_webp(const Image& image, int quality) {
  if (image.channels != 3 || image.empty()) fail("Cannot write a WebP with {} channels.", image.channels);
  std::string rgb(image.data.size(), '\0');
  for (size_t i = 0; i < rgb.size(); ++i)
    rgb[i] = char(uint8_t(std::clamp(image.data[i], 0.0f, 1.0f) * 255 + 0.5f));
  uint8_t* raw = nullptr;
  const int stride = 3 * image.width;
  const size_t size =
      quality == kLossless
          ? WebPEncodeLosslessRGB(data_of(rgb), image.width, image.height, stride, &raw)
          : WebPEncodeRGB(data_of(rgb), image.width, image.height, stride, float(quality), &raw);
  const Bytes out(raw);
  if (size == 0) fail("Cannot make a WebP of {} x {} pixels.", image.width, image.height);
  return {reinterpret_cast<const char*>(out.get()), size};
}

Image decode_webp(const std::string& bytes, const std::string& name) {
  int width = 0, height = 0;
  if (WebPGetInfo(data_of(bytes), bytes.size(), &width, &height))
    readable_size(width, height, bytes.size(), name);
  const Bytes rgb(WebPDecodeRGB(data_of(bytes), bytes.size(), &width, &height));
  if (!rgb) fail("{} is a broken or unusual WebP. Copy it again.", name);
  Image image(width, height, 3);
  for (size_t i = 0; i < image.data.size(); ++i) image.data[i] = float(rgb.get()[i]) / 255.0f;
  return image;
}

}  // namespace cei3d
