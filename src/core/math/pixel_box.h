// SPDX-License-Identifier: Apache-2.0
// A rectangle of pixels, and the camera of that part of an image.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "core/math/camera.h"
#include "core/math/vec2.h"

namespace cei3d {

struct PixelBox {
  int x0 = 0, y0 = 0, width = 0, height = 0;
  bool operator==(const PixelBox&) const = default;
};

// Around the pixels and wider by a share of its longer side, within the limit. Width 0: there are no pixels.
inline PixelBox box_around(std::span<const Vec2f> pixels, double margin, const PixelBox& limit) {
  if (pixels.empty()) return {};
  float x0 = pixels[0].x, x1 = x0, y0 = pixels[0].y, y1 = y0;
  for (const Vec2f p : pixels)
    x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
  const float more = float(margin) * std::max(x1 - x0, y1 - y0);
  const int left = std::max(limit.x0, int(x0 - more)), top = std::max(limit.y0, int(y0 - more));
  return {left, top, std::min(limit.x0 + limit.width, int(x1 + more) + 1) - left,
          std::min(limit.y0 + limit.height, int(y1 + more) + 1) - top};
}

// The camera of the box, at `scale` pixels per pixel; its size is rounded.
inline Camera crop_camera(const Camera& camera, const PixelBox& box, double scale = 1) {
  Camera c = camera;
  c.width = int(std::lround(box.width * scale));
  c.height = int(std::lround(box.height * scale));
  c.fx *= scale;
  c.fy *= scale;
  c.skew *= scale;
  c.cx = (camera.cx - box.x0) * scale;
  c.cy = (camera.cy - box.y0) * scale;
  return c;
}

}  // namespace cei3d
