// SPDX-License-Identifier: Apache-2.0
// Numbers of 16 bits: 11 significant bits, up to 65504. [IEEE 754, binary16]
#pragma once

#include <bit>
#include <cstdint>

namespace cei3d {

// Rounded to the nearest, ties to even; beyond the range: infinity. NaN stays NaN.
inline uint16_t half_from_float(float v) {
  const auto bits = std::bit_cast<uint32_t>(v);
  const auto sign = uint16_t(bits >> 16 & 0x8000u);
  const uint32_t magnitude = bits & 0x7fffffffu;
  if (magnitude > 0x7f800000u) return uint16_t(sign | 0x7e00u);
  if (magnitude >= 0x477ff000u) return uint16_t(sign | 0x7c00u);  // 65520 and more
  if (magnitude < 0x38800000u) {                                  // below 2^-14: steps of 2^-24
    // Adding a half aligns the number so that its last bit is 2^-24; the addition rounds it.
    const float aligned = std::bit_cast<float>(magnitude) + 0.5f;
    return uint16_t(sign | (std::bit_cast<uint32_t>(aligned) - std::bit_cast<uint32_t>(0.5f)));
  }
  const uint32_t odd = magnitude >> 13 & 1;
  return uint16_t(sign | ((magnitude - (112u << 23) + 0xfffu + odd) >> 13));
}

inline float float_from_half(uint16_t h) {
  const uint32_t sign = uint32_t(h & 0x8000u) << 16, magnitude = h & 0x7fffu;
  if (magnitude >= 0x7c00u) return std::bit_cast<float>(sign | 0x7f800000u | (magnitude & 0x3ffu) << 13);
  if (magnitude < 0x400u) {
    const float v = float(magnitude) * 0x1p-24f;
    return sign ? -v : v;
  }
  return std::bit_cast<float>(sign | ((magnitude << 13) + (112u << 23)));
}

}  // namespace cei3d
