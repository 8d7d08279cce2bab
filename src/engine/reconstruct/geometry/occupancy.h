// SPDX-License-Identifier: Apache-2.0
// A coarse grid of signed distances over [-1, 1]^3 that tells which parts of rays are near the surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "core/compute/device.h"
#include "core/math/camera.h"
#include "model/field/field.h"

namespace cei3d {

// Lookups are bound by cache misses: distances are 16-bit fixed point, and cells lie in bricks of 4 x 4 x 4,
// so that successive cells of a ray are close in memory.
class OccupancyGrid {
 public:
  // resolution: cells per axis, a multiple of 4. All cells begin far from the surface.
  explicit OccupancyGrid(int resolution = 128);

  // Updates the distances at the centers of the cells that were within `margin` of the surface so far. Error:
  // interrupted, before any cell has changed.
  void refresh(const Device&, const Field& sdf, float margin, const Progress& progress = Progress());
  void set(std::span<const float> values);  // [z][y][x]; clamped to +-3.9 and rounded to multiples of 1/8192
  std::vector<float> values() const;        // [z][y][x]

  int resolution() const { return n_; }
  float half_diagonal() const { return 1.7320508f / float(n_); }
  Vec3f center(int i) const;  // of cell i of [z][y][x]
  float at(Vec3f p) const {   // clamped to the grid
    return distance(place(cell(p.x), cell(p.y), cell(p.z)));
  }

  struct March {
    float step;            // distance between depths along a ray
    float band;            // distance from the surface within which rays have depths
    float slack = 1;       // possible error of the interpolated distance, in half diagonals of a cell
    int max_depths = 320;  // of a ray
  };
  // Depths along each ray, `step` apart, that lie within `band` of the surface, front to back, from the entry
  // into the unit sphere to the exit, or until the ray is deeper than `band` inside. jitter: [0, 1) of each
  // ray, shifts its first depth by so many steps. depths: ray after ray, appended to; counts: #rays.
  void march(std::span<const Ray> rays, const March&, std::span<const float> jitter,
             std::vector<float>& depths, std::span<int> counts) const;

 private:
  static constexpr float kUnit = 1.0f / 8192;
  struct Walk {
    float t = 0;    // present depth
    float far = 0;  // depth at which the ray leaves the unit sphere
    int found = 0;  // depths near the surface so far
  };
  bool advance(const Ray& ray, const March&, Walk& walk, float* depths) const;
  float interpolated(Vec3f p) const;  // between cell centers
  float distance(size_t place) const { return kUnit * float(value_[place]); }
  void set_distance(size_t place, float d);
  int cell(float x) const { return min(max(int((x + 1) * 0.5f * float(n_)), 0), n_ - 1); }
  size_t place(int x, int y, int z) const {
    const size_t bricks = size_t(n_) / 4, brick = ((z / 4) * bricks + y / 4) * bricks + x / 4;
    return brick * 64 + size_t((z % 4) * 16 + (y % 4) * 4 + x % 4);
  }
  Vec3f center_of(size_t place) const;
  size_t place(int i) const { return place(i % n_, i / n_ % n_, i / n_ / n_); }  // of cell i of [z][y][x]
  int n_;
  std::vector<int16_t> value_;  // [brick][cell]
};

}  // namespace cei3d
