// SPDX-License-Identifier: Apache-2.0
#include "engine/photos/photo_pixels.h"

#include <algorithm>

namespace cei3d {

PixelBox whole(const View& v) { return {0, 0, v.file_camera().width, v.file_camera().height}; }

Image mask_image(const Image& log_odds, const PixelBox& box, const View& view) {
  Image mask(view.file_camera().width, view.file_camera().height, 1);
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x)
      *mask.at(box.x0 + x, box.y0 + y) = *log_odds.at(x, y) > 0 ? 1.0f : 0.0f;
  return mask;
}

PixelBox box_around(const std::vector<Vec2f>& pixels, double margin, const PixelBox& limit) {
  if (pixels.empty()) return {};
  float x0 = pixels[0].x, x1 = x0, y0 = pixels[0].y, y1 = y0;
  for (const Vec2f p : pixels)
    x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
  const float more = float(margin) * std::max(x1 - x0, y1 - y0);
  const int left = std::max(0, int(x0 - more)), top = std::max(0, int(y0 - more));
  return {left, top, std::min(limit.width, int(x1 + more) + 1) - left,
          std::min(limit.height, int(y1 + more) + 1) - top};
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
