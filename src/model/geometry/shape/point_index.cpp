// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/point_index.h"

#include <bit>

namespace cei3d {

PointIndex::PointIndex(std::span<const Vec3f> points, float cell) : cell_(cell) {
  bucket_start_.assign(std::bit_ceil(points.size() + 1) + 1, 0);
  std::vector<uint32_t> bucket_of(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    bucket_of[i] = bucket(GridIndex::of(points[i], cell_));
    ++bucket_start_[bucket_of[i] + 1];
  }
  for (size_t b = 1; b < bucket_start_.size(); ++b) bucket_start_[b] += bucket_start_[b - 1];
  points_.resize(points.size());
  ids_.resize(points.size());
  std::vector<uint32_t> next(bucket_start_.begin(), bucket_start_.end() - 1);
  for (size_t i = 0; i < points.size(); ++i) {
    const uint32_t k = next[bucket_of[i]]++;
    points_[k] = points[i];
    ids_[k] = uint32_t(i);
  }
}

}  // namespace cei3d
