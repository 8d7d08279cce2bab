// SPDX-License-Identifier: Apache-2.0
// An image in memory: float, row 0 at the top, channels interleaved, linear unless a name says srgb.
#pragma once

#include <cstddef>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

struct Image {
  int width = 0, height = 0, channels = 0;
  std::vector<float> data;  // [height][width][channels]

  Image() = default;
  Image(int w, int h, int c, float value = 0)
      : width(w), height(h), channels(c), data(size_t(w) * h * c, value) {}
  float* at(int x, int y) { return &data[(size_t(y) * width + x) * channels]; }
  const float* at(int x, int y) const { return &data[(size_t(y) * width + x) * channels]; }
  Vec3f rgb(int x, int y) const {
    const float* p = at(x, y);
    return channels >= 3 ? Vec3f{p[0], p[1], p[2]} : Vec3f{p[0], p[0], p[0]};
  }
  bool empty() const { return data.empty(); }
};

}  // namespace cei3d
