// SPDX-License-Identifier: Apache-2.0
// A box along the axes.
#pragma once

#include <limits>

#include "core/math/vec.h"

namespace cei3d {

struct AxisBox {
  static constexpr float kFar = std::numeric_limits<float>::infinity();
  Vec3f min{kFar, kFar, kFar}, max{-kFar, -kFar, -kFar};  // empty by default

  void add(Vec3f p) {
    for (int c = 0; c < 3; ++c) {
      min[c] = cei3d::min(p[c], min[c]);
      max[c] = cei3d::max(p[c], max[c]);
    }
  }
  bool contains(Vec3f p) const { return meets({p, p}); }
  bool meets(const AxisBox& b) const {  // borders belong to a box
    return min.x <= b.max.x && min.y <= b.max.y && min.z <= b.max.z && max.x >= b.min.x && max.y >= b.min.y &&
           max.z >= b.min.z;
  }
};

}  // namespace cei3d
