// SPDX-License-Identifier: Apache-2.0
// Uniform hash grid over points: a query looks at 27 cells however many points there are.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

class PointIndex {
 public:
  PointIndex() = default;
  PointIndex(std::span<const Vec3f> points, float cell);  // cell: the largest radius that queries will use

  // Calls visit(i) for points with |p_i - x| < radius (radius <= cell), in ascending i within a cell, until it returns true.
  template <class F>
  bool any_within(Vec3f x, float radius, F visit) const;

  size_t size() const { return points_.size(); }

 private:
  uint32_t bucket(int ix, int iy, int iz) const;
  std::vector<Vec3f> points_;          // sorted by bucket
  std::vector<uint32_t> ids_;          // their indices in the input
  std::vector<uint32_t> bucket_start_; // #buckets + 1
  float cell_ = 1;
};

}  // namespace cei3d
