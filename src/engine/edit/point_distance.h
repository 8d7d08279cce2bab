// SPDX-License-Identifier: Apache-2.0
// Distance to a surface that is given by points with normals, at any distance from it.
#pragma once

#include <vector>

#include "model/geometry/shape/handlers.h"
#include "model/geometry/shape/point_index.h"

namespace cei3d {

class PointDistance {
 public:
  explicit PointDistance(HandlerPoints points);

  // Signed, negative inside: along the normal of the nearest point where that is near, else to the point
  // itself, on the side that its normal tells. [Hoppe et al. 1992]
  float signed_distance(Vec3f x) const;
  // min_h |x - h|_1, as the paper's geometry loss has it: unsigned, and in the norm of sums. [paper eq. 18]
  float l1_distance(Vec3f x) const;

 private:
  struct Level {  // points at a spacing, searched within a radius of some spacings
    HandlerPoints points;
    float radius;
    PointIndex index;
  };
  template <class Norm>
  float nearest(Vec3f x, const Norm& norm, size_t& point) const;  // point: of the finest level

  std::vector<Level> levels_;  // from fine to coarse
};

}  // namespace cei3d
