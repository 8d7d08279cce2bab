// SPDX-License-Identifier: Apache-2.0
#include "engine/io/image_file.h"

#include <array>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <optional>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/math/color.h"
#include "engine/io/color_profile.h"
#include "engine/io/exr_file.h"
#include "engine/io/hdr_file.h"
#include "engine/io/image_limits.h"
#include "engine/io/jpeg_file.h"
#include "engine/io/png_file.h"
#include "engine/io/tiff_file.h"

namespace cei3d {
namespace {

// Number of bytes within which nearly every file states its size.
constexpr size_t kHeaderBytes = size_t(1) << 20;

ImageSize png_size(const std::string& bytes, const std::string& name) {
  if (bytes.size() < 25 || bytes.compare(12, 4, "IHDR") != 0)
    fail("{} is a broken PNG: it ends too early.", name);
  const auto number = [&](size_t i) {
    uint32_t v = 0;
    for (size_t k = 0; k < 4; ++k) v = v << 8 | uint8_t(bytes[i + k]);
    return v;
  };
  return readable_size(number(16), number(20), bytes.size(), name);
}

// Decoding by powf would be most of the loading time; a table of the few values of 8-bit files is exact.
float linear_of_stored(float v) {
  if (!(v >= 0 && v <= 1)) return linear_from_srgb(v);
  static const std::array<std::pair<float, float>, 256> table = [] {
    std::array<std::pair<float, float>, 256> t;
    for (int i = 0; i < 256; ++i) t[i] = {float(i) / 255.0f, linear_from_srgb(float(i) / 255.0f)};
    return t;
  }();
  const auto& [stored, linear] = table[int(v * 255.0f + 0.5f)];
  return stored == v ? linear : linear_from_srgb(v);
}

template <class F>
Image map_colors(Image image, F f) {
  for (size_t i = 0; i < image.data.size(); ++i)
    if (image.channels != 4 || i % 4 != 3) image.data[i] = f(image.data[i]);
  return image;
}

Image decode(const std::string& bytes, const std::string& name, ImageFormat format) {
  switch (format) {
    case ImageFormat::png:
      return decode_png(bytes, name);
    case ImageFormat::jpeg:
      return decode_jpeg(bytes, name);
    case ImageFormat::tiff:
      return decode_tiff(bytes, name).image;
    case ImageFormat::exr:
      return decode_exr(bytes, name);
    case ImageFormat::hdr:
      return decode_hdr(bytes, name);
  }
  fail("{}: unknown image format.", name);
}

struct Stored {
  Image image;
  bool linear = false;
  std::string profile;          // ICC; empty: none
  std::optional<double> gamma;  // png_gamma(), without a profile
};

Stored decode_with_profile(const std::string& bytes, const std::string& name, ImageFormat format) {
  if (format == ImageFormat::tiff) {
    TiffImage tiff = decode_tiff(bytes, name);
    return {std::move(tiff.image), tiff.linear, std::move(tiff.profile), {}};
  }
  const bool linear = format == ImageFormat::exr || format == ImageFormat::hdr;
  Stored stored{decode(bytes, name, format), linear, {}, {}};
  if (format == ImageFormat::jpeg) stored.profile = jpeg_profile(bytes);
  if (format == ImageFormat::png) stored.profile = png_profile(bytes, name);
  if (format == ImageFormat::png && stored.profile.empty()) stored.gamma = png_gamma(bytes, name);
  return stored;
}

// The profile as stored, which may be damaged; none: the file has none.
std::optional<std::string> stored_profile(const std::string& bytes, const std::string& name) {
  const ImageFormat format = image_format(bytes, name);
  if (format == ImageFormat::png && png_has_profile(bytes)) return png_profile(bytes, name);
  std::string profile;
  if (format == ImageFormat::jpeg) profile = jpeg_profile(bytes);
  if (format == ImageFormat::tiff) profile = tiff_profile(bytes, name);
  return profile.empty() ? std::nullopt : std::optional(std::move(profile));
}

std::string start_of(const std::filesystem::path& path) {
  std::string bytes(kHeaderBytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), std::streamsize(bytes.size()));
  bytes.resize(size_t(file.gcount()));
  return bytes;
}

ImageSize size_of(const std::string& bytes, const std::string& name) {
  switch (image_format(bytes, name)) {
    case ImageFormat::png:
      return png_size(bytes, name);
    case ImageFormat::jpeg:
      return jpeg_size(bytes, name);
    case ImageFormat::tiff:
      return tiff_size(bytes, name);
    case ImageFormat::exr:
      return exr_size(bytes, name);
    case ImageFormat::hdr:
      return hdr_size(bytes, name);
  }
  fail("{}: unknown image format.", name);
}

}  // namespace

ImageFormat image_format(const std::string& bytes, const std::string& name) {
  if (bytes.empty()) fail("{} is empty. Copy or render it again.", name);
  if (bytes.rfind("\x89PNG\r\n\x1a\n", 0) == 0) return ImageFormat::png;
  if (bytes.rfind("\xff\xd8", 0) == 0) return ImageFormat::jpeg;
  if (bytes.rfind(std::string("II*\0", 4), 0) == 0 || bytes.rfind(std::string("MM\0*", 4), 0) == 0)
    return ImageFormat::tiff;
  if (bytes.rfind("\x76\x2f\x31\x01", 0) == 0) return ImageFormat::exr;
  if (bytes.rfind("#?", 0) == 0) return ImageFormat::hdr;
  fail("{} is not a PNG, JPEG, TIFF, EXR or Radiance HDR image. Convert it to PNG.", name);
}

Image read_image(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  return decode(bytes, path.string(), image_format(bytes, path.string()));
}

Image read_linear_image(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  const ImageFormat format = image_format(bytes, path.string());
  Stored stored = decode_with_profile(bytes, path.string(), format);
  if (stored.linear) return stored.image;
  if (stored.image.channels >= 3 && !stored.profile.empty() &&
      profile_kind(stored.profile) == ProfileKind::other)
    return linear_by_profile(std::move(stored.image), stored.profile);
  if (stored.gamma)
    return map_colors(std::move(stored.image),
                      [g = float(1 / *stored.gamma)](float v) { return std::pow(v, g); });
  return map_colors(std::move(stored.image), linear_of_stored);
}

ImageSize read_image_size(const std::filesystem::path& path) {
  const std::string start = start_of(path);
  if (start.size() < kHeaderBytes)
    return size_of(read_file(path), path.string());  // says why it cannot be read
  try {
    return size_of(start, path.string());
  } catch (const Error&) {
    return size_of(read_file(path), path.string());  // notes of megabytes before the size
  }
}

ExifNotes read_image_exif(const std::filesystem::path& path) {
  const std::string start = start_of(path);
  return start.rfind("\xff\xd8", 0) == 0 ? read_exif(start) : ExifNotes();
}

bool has_unusable_profile(const std::filesystem::path& path) {
  const std::optional<std::string> profile = stored_profile(read_file(path), path.string());
  return profile && profile_kind(*profile) == ProfileKind::unusable;
}

int read_image_bits(const std::filesystem::path& path) {
  const std::string bytes = read_file(path), name = path.string();
  switch (image_format(bytes, name)) {
    case ImageFormat::png:
      png_size(bytes, name);
      return uint8_t(bytes[24]) == 16 ? 16 : 8;
    case ImageFormat::jpeg:
      return 8;
    case ImageFormat::tiff:
      return tiff_bits(bytes, name);
    case ImageFormat::exr:
    case ImageFormat::hdr:
      return 32;
  }
  fail("{}: unknown image format.", name);
}

bool has_image_suffix(const std::filesystem::path& path) {
  std::string suffix = path.extension().string();
  for (char& c : suffix) c = char(std::tolower(static_cast<unsigned char>(c)));
  return suffix == ".png" || suffix == ".jpg" || suffix == ".jpeg" || suffix == ".tif" || suffix == ".tiff" ||
         suffix == ".exr" || suffix == ".hdr";
}

void write_png(const std::filesystem::path& path, const Image& image, int bits) {
  write_file_atomic(path, encode_png(image, bits));
}
void write_exr(const std::filesystem::path& path, const Image& image) {
  write_file_atomic(path, encode_exr(image));
}
void write_hdr(const std::filesystem::path& path, const Image& image) {
  write_file_atomic(path, encode_hdr(image));
}

Image srgb_from_linear(Image linear) {
  return map_colors(std::move(linear), [](float v) { return srgb_from_linear(v); });
}
Image linear_from_srgb(Image srgb) { return map_colors(std::move(srgb), linear_of_stored); }

}  // namespace cei3d
