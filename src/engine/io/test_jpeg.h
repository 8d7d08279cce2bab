// SPDX-License-Identifier: Apache-2.0
// For tests: JPEG files with notes of a camera or a color profile.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "core/base/bytes.h"
#include "core/math/vec.h"
#include "engine/io/jpeg_file.h"

namespace cei3d {

// The file with one more segment at its beginning.
inline std::string with_segment(const std::string& jpeg, uint8_t marker, const std::string& data) {
  const size_t length = data.size() + 2;
  return jpeg.substr(0, 2) + '\xff' + char(marker) + char(length >> 8) + char(length & 255) + data +
         jpeg.substr(2);
}

// The header of a JPEG of 8 x 6 pixels and four inks, without pixels. transform: 0 CMYK, 2 YCCK. first:
// sampling of the first ink, 0x11 that of the others.
inline std::string ink_jpeg(char transform, char first) {
  const std::string frame{8, 0, 6, 0, 8, 4, 1, first, 0, 2, 0x11, 0, 3, 0x11, 0, 4, 0x11, 0},
      scan{4, 1, 0, 2, 0, 3, 0, 4, 0, 0, 63, 0};
  const std::string adobe = std::string("Adobe\0\x64\0\0\0\0", 11) + transform;
  return with_segment(with_segment(with_segment("\xff\xd8", 0xda, scan), 0xc0, frame), 0xee, adobe);
}

// EXIF: orientation, exposure time 1/50 s, f-number 4, ISO 200. white: 0 balanced by the camera, 1 set by
// hand, none: not noted.
inline std::string with_exif(const std::string& jpeg, uint16_t orientation,
                             std::optional<uint16_t> white = {}) {
  const uint32_t entries = white ? 4 : 3, behind = 38 + 2 + 12 * entries + 4;
  std::string tiff = "II";
  append_bytes(tiff, uint16_t(42));
  append_bytes(tiff, uint32_t(8));
  const auto entry = [&](uint16_t tag, uint16_t type, uint32_t value) {
    append_bytes(tiff, tag), append_bytes(tiff, type), append_bytes(tiff, uint32_t(1)),
        append_bytes(tiff, value);
  };
  append_bytes(tiff, uint16_t(2));
  entry(0x0112, 3, orientation);
  entry(0x8769, 4, 38);
  append_bytes(tiff, uint32_t(0));
  append_bytes(tiff, uint16_t(entries));
  entry(0x829a, 5, behind);
  entry(0x829d, 5, behind + 8);
  entry(0x8827, 3, 200);
  if (white) entry(0xa403, 3, *white);
  append_bytes(tiff, uint32_t(0));
  append_bytes(tiff, std::array<uint32_t, 4>{1, 50, 4, 1});
  return with_segment(jpeg, 0xe1, std::string("Exif\0\0", 6) + tiff);
}

// An ICC profile of three primaries (XYZ under D50), with linear values or sRGB's curve.
inline std::string profile_of(Vec3d red, Vec3d green, Vec3d blue, bool linear) {
  const auto big = [](uint32_t v) {
    return std::string{char(v >> 24), char(v >> 16 & 255), char(v >> 8 & 255), char(v & 255)};
  };
  const auto fixed = [&](double v) { return big(uint32_t(int32_t(std::lround(v * 65536)))); };
  const auto xyz = [&](Vec3d v) {
    return std::string("XYZ ") + big(0) + fixed(v.x) + fixed(v.y) + fixed(v.z);
  };
  const std::string d50 = fixed(0.9642) + fixed(1) + fixed(0.8249);
  const std::string curve = linear ? std::string("curv") + big(0) + big(0)
                                   : std::string("para") + big(0) + big(3 << 16) + fixed(2.4) +
                                         fixed(1 / 1.055) + fixed(0.055 / 1.055) + fixed(1 / 12.92) +
                                         fixed(0.04045);
  const std::pair<const char*, std::string> tags[] = {
      {"rXYZ", xyz(red)}, {"gXYZ", xyz(green)}, {"bXYZ", xyz(blue)}, {"wtpt", xyz({0.9642, 1, 0.8249})},
      {"rTRC", curve},    {"gTRC", curve},      {"bTRC", curve}};
  std::string table = big(7), data;
  for (const auto& [name, bytes] : tags) {
    table += name + big(uint32_t(128 + 4 + 7 * 12 + data.size())) + big(uint32_t(bytes.size()));
    data += bytes;
  }
  const std::string rest = table + data;
  return big(uint32_t(128 + rest.size())) + big(0) + big(0x02400000) + "mntrRGB XYZ " +
         std::string(12, '\0') + "acsp" + std::string(28, '\0') + d50 + std::string(48, '\0') + rest;
}

// Its red is sRGB's green and the reverse.
inline std::string swapped_profile() {
  return profile_of({0.3851, 0.7169, 0.0971}, {0.4361, 0.2225, 0.0139}, {0.1431, 0.0606, 0.7141}, true);
}
// Display P3, as telephones write it.
inline std::string p3_profile() {
  return profile_of({0.5151, 0.2412, -0.0011}, {0.2920, 0.6922, 0.0419}, {0.1571, 0.0666, 0.7841}, false);
}

inline std::string with_profile(const std::string& jpeg, const std::string& profile) {
  return with_segment(jpeg, 0xe2, std::string("ICC_PROFILE\0\1\1", 14) + profile);
}

}  // namespace cei3d
