// SPDX-License-Identifier: Apache-2.0
// Numbers as graphics hardware reads them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/math/octahedron.h"

namespace cei3d {

inline uint8_t unorm8(float x) { return uint8_t(std::lround(clamp(x, 0.0f, 1.0f) * 255)); }
inline uint16_t unorm16(float x) { return uint16_t(std::lround(clamp(x, 0.0f, 1.0f) * 65535)); }
inline int8_t snorm8(float x) { return int8_t(std::lround(clamp(x, -1.0f, 1.0f) * 127)); }
inline int16_t snorm16(float x) { return int16_t(std::lround(clamp(x, -1.0f, 1.0f) * 32767)); }

// Three numbers >= 0 of 9 bits each with a common exponent: red in the lowest bits, the exponent in the upper
// five. Larger numbers than 65408 are cut off. [Khronos OpenGL ES 3.0, sec. 3.8.3]
inline uint32_t shared_exponent(Vec3f color) {
  constexpr int kMantissa = 9, kBias = 15;
  constexpr float kMax = 65408;
  for (int c = 0; c < 3; ++c) color[c] = clamp(color[c], 0.0f, kMax);
  const float largest = std::max({color.x, color.y, color.z});
  int exponent = std::max(-kBias - 1, largest > 0 ? std::ilogb(largest) : -kBias - 1) + 1 + kBias;
  const auto step = [&] { return std::ldexp(1.0f, exponent - kBias - kMantissa); };
  if (std::lround(largest / step()) == 1 << kMantissa) ++exponent;  // rounded up to the next power of two
  uint32_t bits = uint32_t(exponent) << 27;
  for (int c = 0; c < 3; ++c) bits |= uint32_t(std::lround(color[c] / step())) << (9 * c);
  return bits;
}
inline Vec3f from_shared_exponent(uint32_t bits) {
  const float step = std::ldexp(1.0f, int(bits >> 27) - 24);
  return {float(bits & 511) * step, float(bits >> 9 & 511) * step, float(bits >> 18 & 511) * step};
}

// Directions of the nodes of an octahedral map of side x side nodes, row by row, the outer ones on its
// border.
inline Vec3f octahedral_node(int i, int side) {
  const auto position = [&](int node) { return 2 * float(node) / float(side - 1) - 1; };
  return direction_from_octahedron({position(i % side), position(i / side)});
}

}  // namespace cei3d
