// SPDX-License-Identifier: Apache-2.0
// For tests: JPEG files with notes of a camera or a color profile.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "core/base/bytes.h"
#include "engine/io/jpeg_file.h"

namespace cei3d {

// The file with one more segment at its beginning.
inline std::string with_segment(const std::string& jpeg, uint8_t marker, const std::string& data) {
  const size_t length = data.size() + 2;
  return jpeg.substr(0, 2) + '\xff' + char(marker) + char(length >> 8) + char(length & 255) + data +
         jpeg.substr(2);
}

// EXIF: orientation, exposure time 1/50 s, f-number 4, ISO 200.
inline std::string with_exif(const std::string& jpeg, uint16_t orientation) {
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
  append_bytes(tiff, uint16_t(3));
  entry(0x829a, 5, 80);
  entry(0x829d, 5, 88);
  entry(0x8827, 3, 200);
  append_bytes(tiff, uint32_t(0));
  append_bytes(tiff, std::array<uint32_t, 4>{1, 50, 4, 1});
  return with_segment(jpeg, 0xe1, std::string("Exif\0\0", 6) + tiff);
}

// An ICC profile whose red is sRGB's green and the reverse, with linear values.
inline std::string swapped_profile() {
  const auto big = [](uint32_t v) {
    return std::string{char(v >> 24), char(v >> 16 & 255), char(v >> 8 & 255), char(v & 255)};
  };
  const auto fixed = [&](double v) { return big(uint32_t(int32_t(v * 65536 + 0.5))); };
  const auto xyz = [&](double x, double y, double z) {
    return std::string("XYZ ") + big(0) + fixed(x) + fixed(y) + fixed(z);
  };
  const std::string d50 = fixed(0.9642) + fixed(1) + fixed(0.8249);
  const std::pair<const char*, std::string> tags[] = {
      {"rXYZ", xyz(0.3851, 0.7169, 0.0971)},           {"gXYZ", xyz(0.4361, 0.2225, 0.0139)},
      {"bXYZ", xyz(0.1431, 0.0606, 0.7141)},           {"wtpt", xyz(0.9642, 1, 0.8249)},
      {"rTRC", std::string("curv") + big(0) + big(0)}, {"gTRC", std::string("curv") + big(0) + big(0)},
      {"bTRC", std::string("curv") + big(0) + big(0)}};
  std::string table = big(7), data;
  for (const auto& [name, bytes] : tags) {
    table += name + big(uint32_t(128 + 4 + 7 * 12 + data.size())) + big(uint32_t(bytes.size()));
    data += bytes;
  }
  const std::string rest = table + data;
  return big(uint32_t(128 + rest.size())) + big(0) + big(0x02400000) + "mntrRGB XYZ " +
         std::string(12, '\0') + "acsp" + std::string(28, '\0') + d50 + std::string(48, '\0') + rest;
}

inline std::string with_profile(const std::string& jpeg, const std::string& profile) {
  return with_segment(jpeg, 0xe2, std::string("ICC_PROFILE\0\1\1", 14) + profile);
}

}  // namespace cei3d
