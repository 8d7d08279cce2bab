// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/pixels.h"

#include <algorithm>
#include <cmath>

#include "core/image/area.h"
#include "core/math/color.h"
#include "core/math/half.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

namespace {

uint8_t to_byte(float v) { return uint8_t(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)); }

std::array<uint16_t, 3> halves_of(const float* linear) {
  constexpr float kMax = 65504;  // largest finite half float
  std::array<uint16_t, 3> h;
  for (size_t c = 0; c < 3; ++c) h[c] = half_from_float(std::clamp(linear[c], 0.0f, kMax));
  return h;
}

}  // namespace

void PixelStore::add_view(const Camera& unit_camera, const Image& image, int rim, ImageDepth depth) {
  const auto view = uint16_t(cameras_.size());
  cameras_.push_back(unit_camera);
  Area touched(size_t(image.width) * image.height), mask(touched.size());
  for (size_t i = 0; i < touched.size(); ++i) {
    touched[i] = image.data[4 * i + 3] > 0;
    const float alpha = image.data[4 * i + 3];
    mask[i] = alpha < 0 ? kUnknown : alpha > 0.5f ? kObject : kBackground;
  }
  depths_.push_back(depth);
  const bool deep = depth != ImageDepth::bits8;
  if (deep) halves_.resize(pixels_.size());
  const Area keep = dilated(touched, image.width, image.height, rim);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (!keep[size_t(y) * image.width + x] || image.at(x, y)[3] < 0) continue;
      const float* p = image.at(x, y);
      pixels_.push_back({view,
                         uint16_t(x),
                         uint16_t(y),
                         {to_byte(srgb_from_linear(p[0])), to_byte(srgb_from_linear(p[1])),
                          to_byte(srgb_from_linear(p[2])), to_byte(p[3])}});
      if (deep) halves_.push_back(halves_of(p));
    }
  if (!deep && !halves_.empty()) halves_.resize(pixels_.size());
  masks_.push_back(std::move(mask));
}

Vec3f PixelStore::radiance(size_t pixel) const {
  const Pixel& p = pixels_[pixel];
  Vec3f out;
  const bool deep = depths_[p.view] != ImageDepth::bits8;
  for (size_t c = 0; c < 3; ++c)
    out[int(c)] = deep ? float_from_half(halves_[pixel][c]) : linear_from_srgb(float(p.srgba[c]) / 255);
  return exposures_.empty() ? out : out / exposures_[p.view];
}

Target PixelStore::target(const Pixel& p) const {
  const float a = float(p.srgba[3]) / 255;
  Target t{{0, 0, 0}, a};
  for (size_t c = 0; c < 3; ++c) {
    const float own = curves_.empty() ? float(p.srgba[c]) / 255 : curves_[p.view][c][p.srgba[c]];
    t.srgb[int(c)] = own * a + (1 - a);
  }
  return t;
}

void PixelStore::set_exposures(std::vector<Vec3f> factors) {
  exposures_ = std::move(factors);
  curves_.assign(exposures_.size(), {});
  for (size_t v = 0; v < exposures_.size(); ++v)
    for (size_t c = 0; c < 3; ++c)
      for (size_t byte = 0; byte < 256; ++byte)
        curves_[v][c][byte] =
            std::min(srgb_from_linear(linear_from_srgb(float(byte) / 255) / exposures_[v][int(c)]), 1.0f);
}

uint8_t PixelStore::clipped(size_t pixel) const {
  const Pixel& p = pixels_[pixel];
  const ImageDepth depth = depths_[p.view];
  uint8_t bits = 0;
  for (size_t c = 0; c < 3; ++c) {
    const bool full = depth == ImageDepth::bits8    ? p.srgba[c] == 255
                      : depth == ImageDepth::bits16 ? halves_[pixel][c] >= half_from_float(1)
                                                    : false;
    bits |= uint8_t(full << c);
  }
  return bits;
}

}  // namespace cei3d
