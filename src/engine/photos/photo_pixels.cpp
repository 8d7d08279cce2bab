// SPDX-License-Identifier: Apache-2.0
#include "engine/photos/photo_pixels.h"

namespace cei3d {

PixelBox whole(const View& v) { return {0, 0, v.file_camera().width, v.file_camera().height}; }

Image mask_image(const Image& log_odds, const PixelBox& box, const View& view) {
  Image mask(view.file_camera().width, view.file_camera().height, 1);
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x)
      *mask.at(box.x0 + x, box.y0 + y) = *log_odds.at(x, y) > 0 ? 1.0f : 0.0f;
  return mask;
}

std::optional<Vec2d> photo_pixel(const View& v, Vec3d point) {
  const Camera& c = v.file_camera();
  const Vec3d at = c.project(point);
  const std::optional<Vec2d> pixel = v.photo ? project(*v.photo, point) : std::optional(Vec2d{at.x, at.y});
  if (!pixel || at.z <= 0) return std::nullopt;
  if (!(pixel->x >= 0 && pixel->y >= 0 && pixel->x < c.width && pixel->y < c.height)) return std::nullopt;
  return pixel;
}

}  // namespace cei3d
