// SPDX-License-Identifier: Apache-2.0
// Normalized correlation of windows of two images that are related by a plane.
#pragma once

#include <vector>

#include "core/math/camera.h"

namespace cei3d {

// A downscaled gray image of the object.
struct Gray {
  Camera camera;
  std::vector<float> value;   // [y][x], offset so that its mean is about zero
  std::vector<float> inside;  // [y][x], 1: all source pixels are on the object; else 0
  size_t at(int x, int y) const { return size_t(y) * camera.width + x; }
};

// Homography from pixel (x, y) of camera a to camera b over the plane at depth z of a, in homogeneous
// coordinates: z (column + x dx + y dy) + offset.
struct Warp {
  Vec3d column, dx, dy, offset;
};

Warp warp_between(const Camera& a, const Camera& b);

class WindowMatcher {
 public:
  // window: half width, pixels. `a` must outlive the matcher.
  WindowMatcher(const Gray& a, int window);

  // The plane z = depth before `a`; warp: warp_between(a, b). score: [y][x] correlation, -1 where too little
  // of the window is on the object in both images.
  void match(const Gray& b, const Warp& warp, double depth, std::vector<float>& score);

 private:
  size_t padded() const { return size_t(width_) + 2 * size_t(window_); }
  void sample(const Gray& b, const Warp& warp, double depth, int y, std::vector<float>& row);
  void correlate(float* score, int y);

  const Gray& a_;
  int window_, width_;
  // Products of the last rows of pixels, each row padded by `window_` zeros on both sides.
  std::vector<std::vector<float>> rows_;
  std::vector<float> columns_;  // sums of rows_ by column
  std::vector<float> sums_;     // sums over windows
  std::vector<float> warped_, known_;
};

}  // namespace cei3d
