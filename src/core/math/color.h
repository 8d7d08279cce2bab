// SPDX-License-Identifier: Apache-2.0
// Colour: everything is linear Rec.709 unless a name says srgb. [IEC 61966-2-1]
#pragma once

#include "core/math/vec.h"

namespace cei3d {

inline float srgb_from_linear(float c) {
  return c <= 0.0031308f ? 12.92f * c : 1.055f * ::powf(c, 1 / 2.4f) - 0.055f;
}
inline float linear_from_srgb(float c) {
  return c <= 0.04045f ? c / 12.92f : ::powf((c + 0.055f) / 1.055f, 2.4f);
}
inline Vec3f srgb_from_linear(Vec3f c) {
  return {srgb_from_linear(c.x), srgb_from_linear(c.y), srgb_from_linear(c.z)};
}
inline Vec3f linear_from_srgb(Vec3f c) {
  return {linear_from_srgb(c.x), linear_from_srgb(c.y), linear_from_srgb(c.z)};
}
inline float luminance(Vec3f c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

}  // namespace cei3d
