// SPDX-License-Identifier: Apache-2.0
// Image files. The format is detected from the first bytes, not from the name.
#pragma once

#include <filesystem>
#include <string>

#include "core/image/image.h"
#include "engine/io/exif.h"
#include "engine/io/image_size.h"

namespace cei3d {

enum class ImageFormat { png, jpeg, tiff, exr, hdr };

// Values as stored, /255 or /65535: display-encoded for PNG, JPEG and TIFF, linear for EXR and HDR. 1, 3 or 4
// channels. Errors name the file: missing, truncated, corrupt, unknown format.
Image read_image(const std::filesystem::path& path);
// Linear, sRGB primaries, alpha kept: by the image's color profile, else by the exponent that a PNG states,
// else from sRGB. EXR, HDR and TIFF of floating-point numbers are linear as stored.
Image read_linear_image(const std::filesystem::path& path);
ImageSize read_image_size(const std::filesystem::path& path);  // without decoding pixels, as stored
ExifNotes read_image_exif(const std::filesystem::path& path);  // defaults for a file without
// Whether the image has a color profile that is damaged or not one of RGB: it is read as if it had none.
bool has_unusable_profile(const std::filesystem::path& path);
// Bits of a channel: 8 or 16 of display-encoded values up to 1; 32: linear values without an upper limit
// (EXR, HDR).
int read_image_bits(const std::filesystem::path& path);
ImageFormat image_format(const std::string& bytes, const std::string& name);
bool has_image_suffix(const std::filesystem::path& path);  // .png .jpg .jpeg .tif .tiff .exr .hdr, any case

// Writes atomically and makes parent folders. Values are written as they are (see encode_png, encode_exr,
// encode_hdr).
void write_png(const std::filesystem::path& path, const Image& image, int bits = 8);
void write_exr(const std::filesystem::path& path, const Image& image);
void write_hdr(const std::filesystem::path& path, const Image& image);

// Per channel; a fourth channel (alpha) is kept.
Image srgb_from_linear(Image linear);
Image linear_from_srgb(Image srgb);

}  // namespace cei3d
