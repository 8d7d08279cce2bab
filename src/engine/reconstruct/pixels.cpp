// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/pixels.h"

#include <algorithm>
#include <cmath>

#include "core/image/area.h"
#include "core/math/color.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

namespace {

uint8_t to_byte(float v) { return uint8_t(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)); }

}  // namespace

void PixelStore::add_view(const Camera& unit_camera, const Image& image, int rim) {
  const auto view = uint16_t(cameras_.size());
  cameras_.push_back(unit_camera);
  Area touched(size_t(image.width) * image.height), mask(touched.size());
  for (size_t i = 0; i < touched.size(); ++i) {
    touched[i] = image.data[4 * i + 3] > 0;
    const float alpha = image.data[4 * i + 3];
    mask[i] = alpha < 0 ? kUnknown : alpha > 0.5f ? kObject : kBackground;
  }
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
    }
  masks_.push_back(std::move(mask));
}

}  // namespace cei3d
