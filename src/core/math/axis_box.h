// SPDX-License-Identifier: Apache-2.0
// A box along the axes.
#pragma once

#include <limits>
#include <span>

#include "core/math/vec.h"

namespace cei3d {

template <class T>
struct AxisBoxOf {
  static constexpr T kFar = std::numeric_limits<T>::infinity();
  Vec3<T> min{kFar, kFar, kFar}, max{-kFar, -kFar, -kFar};  // empty by default

  void add(Vec3<T> p) {
    for (int c = 0; c < 3; ++c) {
      min[c] = cei3d::min(p[c], min[c]);
      max[c] = cei3d::max(p[c], max[c]);
    }
  }
  Vec3<T> size() const { return max - min; }  // of a box that is not empty
  bool contains(Vec3<T> p) const { return meets({p, p}); }
  bool meets(const AxisBoxOf& b) const {  // borders belong to a box
    return min.x <= b.max.x && min.y <= b.max.y && min.z <= b.max.z && max.x >= b.min.x && max.y >= b.min.y &&
           max.z >= b.min.z;
  }
};
using AxisBox = AxisBoxOf<float>;

template <class T>
AxisBoxOf<T> box_around(std::span<const Vec3<T>> points) {
  AxisBoxOf<T> box;
  for (const Vec3<T>& p : points) box.add(p);
  return box;
}
inline AxisBox box_of(std::span<const Vec3f> points) { return box_around(points); }
inline AxisBoxOf<double> box_of(std::span<const Vec3d> points) { return box_around(points); }

}  // namespace cei3d
