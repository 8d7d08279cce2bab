// SPDX-License-Identifier: Apache-2.0
// A rectangle of pixels, and the camera of that part of an image.
#pragma once

#include "core/math/camera.h"

namespace cei3d {

struct PixelBox {
  int x0 = 0, y0 = 0, width = 0, height = 0;
  bool operator==(const PixelBox&) const = default;
};

// The camera of the box, at `scale` pixels per pixel.
inline Camera crop_camera(const Camera& camera, const PixelBox& box, int scale = 1) {
  Camera c = camera;
  c.width = box.width * scale;
  c.height = box.height * scale;
  c.fx *= scale;
  c.fy *= scale;
  c.skew *= scale;
  c.cx = (camera.cx - box.x0) * scale;
  c.cy = (camera.cy - box.y0) * scale;
  return c;
}

}  // namespace cei3d
