// SPDX-License-Identifier: Apache-2.0
// "Does this surface point belong to the edit": within reach of an edited handler point, on the same side of the
// surface, and not nearer to an unedited one. [paper eq. 9, with reach by local spacing: architecture 1.2]
#pragma once

#include <vector>

#include "core/math/vec.h"
#include "model/geometry/point_index.h"

namespace cei3d {

class Region {
 public:
  Region() = default;
  struct Points {
    std::vector<Vec3f> positions;  // #N edited points (H+), unit-sphere frame
    std::vector<Vec3f> normals;    // #N
    std::vector<float> reach;      // #N, unit-sphere units
  };
  explicit Region(Points points);

  bool contains(Vec3f position, Vec3f normal) const;
  const Points& points() const { return points_; }

 private:
  Points points_;
  PointIndex index_;
};

}  // namespace cei3d
