// SPDX-License-Identifier: Apache-2.0
#include "engine/metrics/psnr.h"

#include <vector>

#include "core/base/error.h"
#include "core/math/psnr.h"

namespace cei3d {
namespace {

void require_pair(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.channels != 3 || b.channels != 3 || a.empty())
    fail(
        "Cannot compare an image of {} x {} x {} with one of {} x {} x {}: render at the size of the "
        "photographs.",
        a.width, a.height, a.channels, b.width, b.height, b.channels);
}

}  // namespace

Image over_background(const Image& image, float background) {
  Image out(image.width, image.height, 3);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Vec3f rgb = image.rgb(x, y);
      const float a = image.channels == 4 ? image.at(x, y)[3] : 1.0f;
      for (int c = 0; c < 3; ++c) out.at(x, y)[c] = rgb[c] * a + background * (1 - a);
    }
  return out;
}

double psnr(const Image& a, const Image& b) {
  require_pair(a, b);
  return *psnr_in_mask(a, b, std::vector<uint8_t>(size_t(a.width) * a.height, 1));
}

std::optional<double> psnr_in_mask(const Image& a, const Image& b, std::span<const uint8_t> mask) {
  require_pair(a, b);
  if (mask.size() != size_t(a.width) * a.height)
    fail("A mask of {} pixels does not fit an image of {} x {}.", mask.size(), a.width, a.height);
  double sum = 0;
  size_t n = 0;
  for (size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i]) continue;
    ++n;
    for (size_t c = 0; c < 3; ++c) {
      const double d = double(a.data[3 * i + c]) - b.data[3 * i + c];
      sum += d * d;
    }
  }
  if (n == 0) return std::nullopt;
  return psnr_of_mse(sum / (3.0 * double(n)));
}

}  // namespace cei3d
