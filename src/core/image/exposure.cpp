// SPDX-License-Identifier: Apache-2.0
#include "core/image/exposure.h"

#include <algorithm>

#include "core/math/color.h"

namespace cei3d {
namespace {

constexpr float kDark = 0.08f, kClipped = 0.97f;  // display-encoded
constexpr size_t kMinPixels = 50;

bool is_informative(float v) { return v > kDark && v < kClipped; }

}  // namespace

std::optional<Vec3f> exposure_between(const Image& shown, const Image& photo, const Area& area) {
  Vec3f factors;
  for (int c = 0; c < 3; ++c) {
    double of_shown = 0, of_photo = 0;
    size_t pixels = 0;
    for (size_t i = 0; i < area.size(); ++i) {
      const float a = shown.data[i * size_t(shown.channels) + size_t(c)],
                  b = photo.data[i * size_t(photo.channels) + size_t(c)];
      if (!area[i] || !is_informative(a) || !is_informative(b)) continue;
      of_shown += linear_from_srgb(a), of_photo += linear_from_srgb(b);
      ++pixels;
    }
    if (pixels < kMinPixels) return std::nullopt;
    factors[c] = float(of_photo / of_shown);
  }
  return factors;
}

Image exposed(Image srgb, Vec3f factors) {
  for (size_t i = 0; i < srgb.data.size(); i += size_t(srgb.channels))
    for (int c = 0; c < 3; ++c) {
      float& v = srgb.data[i + size_t(c)];
      v = std::min(srgb_from_linear(factors[c] * linear_from_srgb(v)), 1.0f);
    }
  return srgb;
}

}  // namespace cei3d
