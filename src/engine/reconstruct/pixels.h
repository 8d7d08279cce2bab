// SPDX-License-Identifier: Apache-2.0
// The training pixels of the object and a rim around it, packed into 12 bytes each, so that 100 views of 800
// x 800 fit in memory.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/image/image.h"
#include "core/math/camera.h"

namespace cei3d {

struct Pixel {
  uint16_t view, x, y;
  std::array<uint8_t, 4> srgba;  // display-encoded color, straight alpha
};

class PixelStore {
 public:
  // image: RGBA, linear, straight alpha, below 0 where unknown. Keeps known pixels with an alpha above zero
  // within `rim` pixels.
  void add_view(const Camera& unit_camera, const Image& image, int rim);

  const std::vector<Camera>& cameras() const { return cameras_; }
  const std::vector<Pixel>& pixels() const { return pixels_; }
  // Of each view, row-major: kObject where alpha > 0.5, kUnknown where alpha < 0 (visual_hull.h).
  const std::vector<std::vector<uint8_t>>& masks() const { return masks_; }
  // Ray through the center of a pixel plus `away` (pixels), unit frame.
  Ray ray(const Pixel& p, Vec2f away = {0, 0}) const {
    return cameras_[p.view].ray(float(p.x) + 0.5f + away.x, float(p.y) + 0.5f + away.y);
  }

 private:
  std::vector<Camera> cameras_;
  std::vector<Pixel> pixels_;
  std::vector<std::vector<uint8_t>> masks_;
};

// Display-encoded color over white, and coverage.
struct Target {
  Vec3f srgb;
  float alpha;
};
inline Target target_of(const Pixel& p) {
  const float a = float(p.srgba[3]) / 255;
  const auto over = [&](int c) { return float(p.srgba[c]) / 255 * a + (1 - a); };
  return {{over(0), over(1), over(2)}, a};
}

}  // namespace cei3d
