// SPDX-License-Identifier: Apache-2.0
// How well windows of one picture agree with another's, seen through a plane: normalized correlation.
#pragma once

#include <vector>

#include "core/math/camera.h"

namespace cei3d {

// A gray picture of the object, shrunk.
struct Gray {
  Camera camera;
  std::vector<float> value;   // [y][x], about zero
  std::vector<float> inside;  // 1: all its pixels are on the object; else 0
  size_t at(int x, int y) const { return size_t(y) * camera.width + x; }
};

// Where the points of the plane at z = 1 before `a` lie in `b`'s picture, homogeneous: z (column + x dx + y
// dy) + offset.
struct Warp {
  Vec3d column, dx, dy, offset;
};

Warp warp_between(const Camera& a, const Camera& b);

class WindowMatcher {
 public:
  // window: half width, pixels. `a` must outlive the matcher.
  WindowMatcher(const Gray& a, int window);

  // The plane z = depth before `a`; warp: warp_between(a, b). score: [y][x] correlation, -1 where too little
  // of the window is on the object in both pictures.
  void match(const Gray& b, const Warp& warp, double depth, std::vector<float>& score);

 private:
  size_t padded() const { return size_t(width_) + 2 * size_t(window_); }
  void sample(const Gray& b, const Warp& warp, double depth, int y, std::vector<float>& row);
  void correlate(float* score, int y);

  const Gray& a_;
  int window_, width_;
  std::vector<std::vector<float>>
      rows_;                    // products of the last rows, `window_` columns of zeros on both sides
  std::vector<float> columns_;  // their sums
  std::vector<float> sums_;     // of windows
  std::vector<float> warped_, known_;
};

}  // namespace cei3d
