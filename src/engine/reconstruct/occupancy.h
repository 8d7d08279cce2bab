// SPDX-License-Identifier: Apache-2.0
// A coarse grid of signed distances over [-1, 1]^3 that tells where rays must look.
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "core/math/camera.h"
#include "model/field/field.h"

namespace cei3d {

class OccupancyGrid {
 public:
  explicit OccupancyGrid(int resolution = 128) : n_(resolution), value_(size_t(n_) * n_ * n_, 1e3f) {}

  // Distances at cell centres: of every cell, or of those nearer than `margin` to the surface when last
  // asked.
  void refresh(const Device&, const Field& sdf, float margin);
  void set(std::vector<float> values) { value_ = std::move(values); }

  const std::vector<float>& values() const { return value_; }

  int resolution() const { return n_; }
  float half_diagonal() const { return 1.7320508f / float(n_); }
  Vec3f center(int i) const;  // of cell i
  float at(Vec3f p) const {   // clamped to the grid
    return value_[(size_t(cell(p.z)) * n_ + cell(p.y)) * n_ + cell(p.x)];
  }

  // Depths along the ray, `step` apart, that lie within `band` of the surface, front to back, from the unit
  // sphere's entry to its exit or until the ray is deeper than `band` inside. `jitter` in [0, 1) shifts the
  // first one.
  void march(const Ray& ray, float step, float band, float jitter, int most,
             std::vector<float>& depths) const;

 private:
  int cell(float x) const { return min(max(int((x + 1) * 0.5f * float(n_)), 0), n_ - 1); }
  int n_;
  std::vector<float> value_;  // [z][y][x]
};

// Entry and exit of the unit sphere; false when the ray misses it.
bool unit_sphere_span(const Ray& ray, float& near, float& far);

}  // namespace cei3d
