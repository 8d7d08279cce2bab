// SPDX-License-Identifier: Apache-2.0
#include "core/image/exposure.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/math/color.h"
#include "core/math/quantile.h"

namespace cei3d {
namespace {

constexpr float kDark = 0.08f, kClipped = 0.97f;  // display-encoded
constexpr size_t kFewest = 50;                    // pixels

bool tells(float v) { return v > kDark && v < kClipped; }

}  // namespace

std::optional<Vec3f> exposure_between(const Image& shown, const Image& photo, const Area& area) {
  Vec3f factors;
  for (int c = 0; c < 3; ++c) {
    std::vector<float> logs;
    for (size_t i = 0; i < area.size(); ++i) {
      const float a = shown.data[i * size_t(shown.channels) + size_t(c)],
                  b = photo.data[i * size_t(photo.channels) + size_t(c)];
      if (area[i] && tells(a) && tells(b))
        logs.push_back(std::log(linear_from_srgb(b) / linear_from_srgb(a)));
    }
    if (logs.size() < kFewest) return std::nullopt;
    factors[c] = std::exp(median(std::move(logs)));
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
