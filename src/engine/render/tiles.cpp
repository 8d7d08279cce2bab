// SPDX-License-Identifier: Apache-2.0
#include "engine/render/tiles.h"

#include <algorithm>

#include "core/image/resample.h"

namespace cei3d {
namespace {

// A pixel depends on the samples of its eight neighbors, and how many samples those have on their neighbors.
constexpr int kMargin = 2;

PixelBox grown(const PixelBox& b, int width, int height) {
  const int x0 = std::max(b.x0 - kMargin, 0), y0 = std::max(b.y0 - kMargin, 0);
  return {x0, y0, std::min(b.x0 + b.width + kMargin, width) - x0,
          std::min(b.y0 + b.height + kMargin, height) - y0};
}

// Squared distance of the middle of the box to the middle of the image, times four.
int from_middle(const PixelBox& b, int width, int height) {
  const int x = 2 * b.x0 + b.width - width, y = 2 * b.y0 + b.height - height;
  return x * x + y * y;
}

}  // namespace

std::vector<PixelBox> tiles_of(int width, int height, int side) {
  std::vector<PixelBox> tiles;
  for (int y = 0; y < height; y += side)
    for (int x = 0; x < width; x += side)
      tiles.push_back({x, y, std::min(side, width - x), std::min(side, height - y)});
  std::stable_sort(tiles.begin(), tiles.end(), [&](const PixelBox& a, const PixelBox& b) {
    return from_middle(a, width, height) < from_middle(b, width, height);
  });
  return tiles;
}

Frame cropped(const Frame& f, const PixelBox& b) {
  Frame out;
  for (const auto image : {&Frame::rgb, &Frame::albedo, &Frame::diffuse, &Frame::specular, &Frame::normal,
                           &Frame::depth, &Frame::roughness, &Frame::metalness, &Frame::mask})
    out.*image = cropped(f.*image, b);
  for (int y = 0; y < b.height; ++y) {
    const auto row = f.edited.begin() + std::ptrdiff_t(b.y0 + y) * f.mask.width + b.x0;
    out.edited.insert(out.edited.end(), row, row + b.width);
  }
  return out;
}

Frame render_tile(RenderCache& frames, const Scene& scene, const SceneLight& light, const Camera& camera,
                  int samples, const PixelBox& box) {
  const PixelBox outer = grown(box, camera.width, camera.height);
  const auto view = frames.trace(scene, crop_camera(camera, outer), samples);
  const PixelBox inner{box.x0 - outer.x0, box.y0 - outer.y0, box.width, box.height};
  return cropped(frames.shade(scene, light, *view), inner);
}

}  // namespace cei3d
