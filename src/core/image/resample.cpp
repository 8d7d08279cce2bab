// SPDX-License-Identifier: Apache-2.0
#include "core/image/resample.h"

#include <algorithm>

#include "core/base/error.h"

namespace cei3d {
namespace {

void mean_of_block(const Image& image, int x0, int y0, int n, float* out) {
  const int colors = image.channels == 4 ? 3 : image.channels;
  std::vector<double> sum(size_t(colors), 0.0);
  double weight = 0;
  for (int y = y0; y < y0 + n; ++y)
    for (int x = x0; x < x0 + n; ++x) {
      const float* p = image.at(x, y);
      const double w = image.channels == 4 ? p[3] : 1.0;
      for (int c = 0; c < colors; ++c) sum[c] += w * p[c];
      weight += w;
    }
  for (int c = 0; c < colors; ++c) out[c] = weight > 0 ? float(sum[c] / weight) : 0.0f;
  if (image.channels == 4) out[3] = float(weight / (double(n) * n));
}

}  // namespace

Image downscale(const Image& image, int n) {
  if (n == 1) return image;
  if (n < 1 || n > image.width || n > image.height)
    fail_usage("Cannot scale an image of {} x {} pixels down by {}: choose a factor from 1 to {}.",
               image.width, image.height, n, std::min(image.width, image.height));
  Image out(image.width / n, image.height / n, image.channels);
  for (int y = 0; y < out.height; ++y)
    for (int x = 0; x < out.width; ++x) mean_of_block(image, x * n, y * n, n, out.at(x, y));
  return out;
}

}  // namespace cei3d
