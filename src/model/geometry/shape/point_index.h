// SPDX-License-Identifier: Apache-2.0
// Uniform hash grid over points: a query visits 27 cells whatever the number of points.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

// A cell of a uniform grid. Points farther than 2^30 cells from the origin share the outermost cells.
struct GridIndex {
  int x = 0, y = 0, z = 0;
  static GridIndex of(Vec3f p, float cell) { return {axis(p.x / cell), axis(p.y / cell), axis(p.z / cell)}; }
  bool operator==(const GridIndex&) const = default;
  uint32_t hash() const {
    return uint32_t(x) * 73856093u ^ uint32_t(y) * 19349663u ^ uint32_t(z) * 83492791u;
  }

 private:
  static int axis(float t) { return int(std::floor(clamp(t, -1073741824.0f, 1073741824.0f))); }
};

// The cells around a cell, the cell itself first, because most successful queries end there.
inline constexpr GridIndex kCellNeighbors[27] = {
    {0, 0, 0},   {-1, 0, 0},  {1, 0, 0},   {0, -1, 0}, {0, 1, 0},   {0, 0, -1},   {0, 0, 1},
    {-1, -1, 0}, {1, -1, 0},  {-1, 1, 0},  {1, 1, 0},  {-1, 0, -1}, {1, 0, -1},   {-1, 0, 1},
    {1, 0, 1},   {0, -1, -1}, {0, 1, -1},  {0, -1, 1}, {0, 1, 1},   {-1, -1, -1}, {1, -1, -1},
    {-1, 1, -1}, {1, 1, -1},  {-1, -1, 1}, {1, -1, 1}, {-1, 1, 1},  {1, 1, 1}};

class PointIndex {
 public:
  PointIndex() = default;
  // cell: the largest radius that queries will use, > 0.
  PointIndex(std::span<const Vec3f> points, float cell);

  // Calls visit(i), once each, for points with |p_i - x| < radius (radius <= cell), in ascending i within a
  // cell, until it returns true. Returns whether it did.
  template <class F>
  bool any_within(Vec3f x, float radius, F visit) const {
    if (points_.empty()) return false;
    const GridIndex home = GridIndex::of(x, cell_);
    for (const GridIndex& d : kCellNeighbors) {
      const GridIndex c{home.x + d.x, home.y + d.y, home.z + d.z};
      const uint32_t b = bucket(c);
      for (uint32_t k = bucket_start_[b]; k < bucket_start_[b + 1]; ++k) {
        const Vec3f to_point = points_[k] - x;
        if (dot(to_point, to_point) >= radius * radius) continue;
        if (!(GridIndex::of(points_[k], cell_) == c)) continue;  // other cell, same bucket
        if (visit(size_t(ids_[k]))) return true;
      }
    }
    return false;
  }

  size_t size() const { return points_.size(); }

 private:
  uint32_t bucket(GridIndex c) const { return c.hash() & uint32_t(bucket_start_.size() - 2); }
  std::vector<Vec3f> points_;           // sorted by bucket
  std::vector<uint32_t> ids_;           // their indices in the input
  std::vector<uint32_t> bucket_start_;  // #buckets + 1, #buckets a power of two
  float cell_ = 1;
};

}  // namespace cei3d
