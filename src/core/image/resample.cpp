// SPDX-License-Identifier: Apache-2.0
#include "core/image/resample.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/math/bilinear.h"

namespace cei3d {
namespace {

void mean_of_block(const Image& image, int x0, int y0, int n, float* out) {
  const int colors = image.channels == 4 ? 3 : image.channels;
  std::vector<double> sum(size_t(colors), 0.0);
  double weight = 0;
  bool unknown = false;
  for (int y = y0; y < y0 + n; ++y)
    for (int x = x0; x < x0 + n; ++x) {
      const float* p = image.at(x, y);
      const double w = image.channels == 4 ? std::max(p[3], 0.0f) : 1.0;
      unknown |= image.channels == 4 && p[3] < 0;
      for (int c = 0; c < colors; ++c) sum[c] += w * p[c];
      weight += w;
    }
  for (int c = 0; c < colors; ++c) out[c] = weight > 0 ? float(sum[c] / weight) : 0.0f;
  if (image.channels == 4) out[3] = unknown ? -1.0f : float(weight / (double(n) * n));
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

Image scaled_to(const Image& image, int width, int height) {
  Image out(width, height, image.channels);
  const auto place = [](int i, int n, int from) {
    return std::clamp((i + 0.5) * from / n - 0.5, 0.0, double(from - 1));
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = place(x, width, image.width), v = place(y, height, image.height);
      const int x0 = int(u), y0 = int(v), x1 = std::min(x0 + 1, image.width - 1),
                y1 = std::min(y0 + 1, image.height - 1);
      const auto s = float(u - x0), t = float(v - y0);
      for (int c = 0; c < image.channels; ++c)
        out.at(x, y)[c] = bilinear(
            {image.at(x0, y0)[c], image.at(x1, y0)[c], image.at(x0, y1)[c], image.at(x1, y1)[c]}, s, t);
    }
  return out;
}

Image cropped(const Image& image, const PixelBox& box) {
  Image out(box.width, box.height, image.channels);
  for (int y = 0; y < box.height; ++y)
    std::copy_n(image.at(box.x0, box.y0 + y), size_t(box.width) * image.channels, out.at(0, y));
  return out;
}

Image turned(Image image, int orientation) {
  if (orientation < 5 || orientation > 8) return image;
  const int w = image.width, h = image.height;
  const bool from_right = orientation == 7 || orientation == 8,
             from_below = orientation == 6 || orientation == 7;
  Image out(h, w, image.channels);
  for (int y = 0; y < w; ++y)
    for (int x = 0; x < h; ++x)
      std::copy_n(image.at(from_right ? w - 1 - y : y, from_below ? h - 1 - x : x), image.channels,
                  out.at(x, y));
  return out;
}

}  // namespace cei3d
