// SPDX-License-Identifier: Apache-2.0
// Rays that stand for the reflection lobe of a hit, each for the same share of its energy.
#pragma once

#include <vector>

#include "core/math/vec.h"
#include "model/geometry/shape/hit.h"
#include "model/material/material.h"

namespace cei3d {

inline constexpr int kMinLobeRays = 4;
// Number of rays for a hit that is seen at cosine nv to its normal.
int lobe_ray_count(const Material&, float nv);

// #count points of a lobe of unit width.
std::vector<Vec2f> lobe_points(int count);

// The rays of one hit. Their pattern is turned about the lobe's axis by an angle that changes from hit to
// hit, so that its errors become noise, which the samples of a pixel average.
class LobeRays {
 public:
  LobeRays(const Hit&, const Material&);
  // Unit direction of the ray at a point of lobe_points(). Directions below the horizon are folded up: the
  // split sum already holds the masking.
  Vec3f at(Vec2f point) const;

 private:
  Vec3f normal_, axis_;
  Vec3f x_, y_;  // where a point's coordinates lead in the plane tangent to the axis
};

}  // namespace cei3d
