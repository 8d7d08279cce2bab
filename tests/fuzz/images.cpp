// SPDX-License-Identifier: Apache-2.0
// libFuzzer target: image files, and what photographs carry besides pixels. The format is told from the
// content.
#include <string>
#include <utility>

#include "engine/io/color_profile.h"
#include "engine/io/exif.h"
#include "engine/io/exr_file.h"
#include "engine/io/hdr_file.h"
#include "engine/io/image_file.h"
#include "engine/io/jpeg_file.h"
#include "engine/io/png_file.h"
#include "engine/io/tiff_file.h"
#include "tests/fuzz/target.h"

namespace {
// As read_linear_image() does it, of small images: the profile is read once and then applied to every pixel.
void use_profile(cei3d::Image image, const std::string& profile) {
  constexpr size_t kMaxPixels = size_t(1) << 12;
  if (size_t(image.width) * size_t(image.height) > kMaxPixels || image.channels < 3) return;
  if (!profile.empty() && cei3d::profile_kind(profile) == cei3d::ProfileKind::other)
    cei3d::linear_by_profile(std::move(image), profile);
}

void decode(const std::string& bytes) {
  using cei3d::ImageFormat;
  switch (cei3d::image_format(bytes, "input")) {
    case ImageFormat::png: {
      cei3d::png_has_profile(bytes);
      cei3d::png_gamma(bytes, "input");
      const std::string profile = cei3d::png_profile(bytes, "input");
      use_profile(cei3d::decode_png(bytes, "input"), profile);
      break;
    }
    case ImageFormat::jpeg: {
      cei3d::read_exif(bytes);
      const std::string profile = cei3d::jpeg_profile(bytes);
      use_profile(cei3d::decode_jpeg(bytes, "input"), profile);
      break;
    }
    case ImageFormat::tiff: {
      cei3d::TiffImage tiff = cei3d::decode_tiff(bytes, "input");
      use_profile(std::move(tiff.image), tiff.profile);
      break;
    }
    case ImageFormat::exr:
      cei3d::decode_exr(bytes, "input");
      break;
    case ImageFormat::hdr:
      cei3d::decode_hdr(bytes, "input");
      break;
  }
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  return fuzz_bytes(data, size, decode);
}
