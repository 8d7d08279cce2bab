// SPDX-License-Identifier: Apache-2.0
// Color spaces. Colors are linear with sRGB primaries (Rec. 709) unless a name says srgb. [IEC 61966-2-1]
#pragma once

#include "core/math/vec.h"

namespace cei3d {

// The display curve, for scalars and dual numbers.
template <class T>
HD T srgb_from_linear(T c) {
  return select(c <= T(0.0031308f), T(12.92f) * c, T(1.055f) * pow(c, 1 / 2.4f) - T(0.055f));
}
// d srgb / d linear.
template <class T>
HD T srgb_derivative(T linear) {
  return select(linear <= T(0.0031308f), T(12.92f), T(1.055f / 2.4f) * pow(linear, 1 / 2.4f - 1));
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
// Oklab: Euclidean distances are approximately perceptual; the first component is lightness, 1 for white.
// [Ottosson 2020]
inline Vec3f oklab_from_linear(Vec3f c) {
  const float l = ::cbrtf(max(0.4122214708f * c.x + 0.5363325363f * c.y + 0.0514459929f * c.z, 0.0f));
  const float m = ::cbrtf(max(0.2119034982f * c.x + 0.6806995451f * c.y + 0.1073969566f * c.z, 0.0f));
  const float s = ::cbrtf(max(0.0883024619f * c.x + 0.2817188376f * c.y + 0.6299787005f * c.z, 0.0f));
  return {0.2104542553f * l + 0.7936177850f * m - 0.0040720468f * s,
          1.9779984951f * l - 2.4285922050f * m + 0.4505937099f * s,
          0.0259040371f * l + 0.7827717662f * m - 0.8086757660f * s};
}
inline float luminance(Vec3f c) { return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z; }

}  // namespace cei3d
