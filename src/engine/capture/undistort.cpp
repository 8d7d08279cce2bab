// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/undistort.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace cei3d {
namespace {

constexpr int kMargin = 8;         // pixels around the object
constexpr double kWidest = 1.732;  // tangent of 60 degrees

using Weights = std::array<float, 4>;  // of the samples at -1, 0, 1, 2

Weights cubic_weights(float t) {  // [Keys 1981]
  const float s = 1 - t;
  return {-0.5f * t * s * s, 1 + t * t * (1.5f * t - 2.5f), 1 + s * s * (1.5f * s - 2.5f), -0.5f * s * t * t};
}
Weights linear_weights(float t) { return {0, 1 - t, t, 0}; }

class Sampler {
 public:
  Sampler(const Image& image, Weights (*weights)(float)) : image_(image), weights_(weights) {}

  // Samples beyond the border repeat it. out: one value for each channel.
  void sample(Vec2d pixel, float* out) const {
    const double x = pixel.x - 0.5, y = pixel.y - 0.5, x0 = std::floor(x), y0 = std::floor(y);
    const Weights wx = weights_(float(x - x0)), wy = weights_(float(y - y0));
    const int channels = image_.channels, colors = channels == 4 ? 3 : channels;
    std::array<double, 4> sum{};
    double alpha = 0;
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const float* p = image_.at(std::clamp(int(x0) + i - 1, 0, image_.width - 1),
                                   std::clamp(int(y0) + j - 1, 0, image_.height - 1));
        const double w = double(wx[i]) * wy[j], a = channels == 4 ? w * p[3] : w;
        for (int c = 0; c < colors; ++c) sum[c] += a * p[c];
        alpha += a;
      }
    for (int c = 0; c < colors; ++c)
      out[c] = std::abs(alpha) > 1e-6 ? std::max(0.0f, float(sum[c] / alpha)) : 0.0f;
    if (channels == 4) out[3] = std::clamp(float(alpha), 0.0f, 1.0f);
  }

 private:
  const Image& image_;
  Weights (*weights_)(float);
};

Image resampled(const Image& image, const PhotoCamera& photo, const Camera& pinhole,
                Weights (*weights)(float), float outside) {
  const Sampler source(image, weights);
  const int last = image.channels - 1;
  Image out(pinhole.width, pinhole.height, image.channels);
  parallel_ranges(out.height, 16, [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < out.width; ++x) {
        const auto at = photo_from_pinhole(photo, pinhole, {x + 0.5, y + 0.5});
        if (at && at->x >= 0 && at->y >= 0 && at->x <= image.width && at->y <= image.height)
          source.sample(*at, out.at(x, y));
        else
          out.at(x, y)[last] = outside;
      }
  });
  return out;
}

struct Bounds {
  double x0 = 1e300, y0 = 1e300, x1 = -1e300, y1 = -1e300;
  void add(Vec2d p) {
    x0 = std::min(x0, p.x), x1 = std::max(x1, p.x);
    y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
  }
};

// Where the border of the box lies in the pinhole camera; corners beyond the reach of the lens are left out.
Bounds border_of(const PhotoCamera& photo, const Camera& pinhole, const PhotoBox& box) {
  Bounds bounds;
  const auto add = [&](double x, double y) {
    if (const auto p = pinhole_from_photo(photo, pinhole, {x, y})) bounds.add(*p);
  };
  constexpr int kSteps = 32;
  for (int i = 0; i <= kSteps; ++i) {
    const double x = box.x0 + double(box.x1 - box.x0) * i / kSteps,
                 y = box.y0 + double(box.y1 - box.y0) * i / kSteps;
    add(x, box.y0), add(x, box.y1), add(box.x0, y), add(box.x1, y);
  }
  return bounds;
}

}  // namespace

Camera pinhole_around(const PhotoCamera& photo, const PhotoBox& box, const std::string& name) {
  Camera c = photo.camera();
  const Bounds b = border_of(photo, c, box);
  const double widest = kWidest * std::max(c.fx, c.fy);
  if (!(b.x1 > b.x0 && b.y1 > b.y0) ||
      std::max({c.cx - b.x0, b.x1 - c.cx, c.cy - b.y0, b.y1 - c.cy}) > widest + 1)
    fail(
        "The lens of view {} sees the object farther than 60 degrees from its axis, or its coefficients are "
        "wrong. Check the camera model and the order of its coefficients.",
        name);
  const int x0 = int(std::floor(b.x0)) - kMargin, y0 = int(std::floor(b.y0)) - kMargin;
  const int width = int(std::ceil(b.x1)) + kMargin - x0, height = int(std::ceil(b.y1)) + kMargin - y0;
  if (width > 2 * c.width + 2 * kMargin || height > 2 * c.height + 2 * kMargin)
    fail(
        "Undistorted, view {} would be {} x {} pixels, more than twice its photograph. Check the camera "
        "model and the order of its coefficients.",
        name, width, height);
  const bool same_size = width == c.width && height == c.height;
  c.width = width + same_size;
  c.height = height;
  c.cx -= x0;
  c.cy -= y0;
  c.skew = photo.camera().skew;
  return c;
}

Image undistorted(const Image& image, const PhotoCamera& photo, const Camera& pinhole) {
  return resampled(image, photo, pinhole, cubic_weights, kUnknownAlpha);
}

Image drawn_on_view(const View& view, Image drawing) {
  if (!view.photo) return drawing;
  const Camera& c = view.photo->camera();
  if (drawing.width != c.width || drawing.height != c.height) return drawing;
  return resampled(drawing, *view.photo, view.camera, linear_weights, 0);
}

Vec2d position_on_view(const View& view, Vec2d photo_pixel) {
  if (!view.photo) return photo_pixel;
  const auto p = pinhole_from_photo(*view.photo, view.camera, photo_pixel);
  if (!p)
    fail_usage("The lens of view {} shows nothing at {:.6g},{:.6g}.", view.name, photo_pixel.x,
               photo_pixel.y);
  return *p;
}

}  // namespace cei3d
