// SPDX-License-Identifier: Apache-2.0
// Handler points that say how much they belong to a part. Between them the scores are interpolated, so the
// part ends where the interpolated score is one half: finer than the points' spacing, and smooth.
#pragma once

#include <vector>

#include "core/base/json.h"
#include "core/base/tensors.h"
#include "core/math/vec.h"
#include "model/geometry/shape/point_index.h"

namespace cei3d {

class ScoredPoints {
 public:
  struct Data {
    std::vector<Vec3f> positions;  // #N, unit-sphere frame
    std::vector<Vec3f> normals;    // #N, unit, outward
    std::vector<float> scores;     // #N, [0, 1]; from 1/2 on: of the part
    float spacing = 0;             // between neighboring points, unit-sphere units
  };

  ScoredPoints() = default;  // nothing scores
  // Keeps only the points that can matter to `score() >= 1/2`.
  explicit ScoredPoints(const Data&);

  bool empty() const { return data_.positions.empty(); }
  const Data& data() const { return data_; }

  // Mean score of the points within 2.5 spacings on the same side of the surface, near ones weighing more; 0
  // where there is none. Exact where it is at least 1/2; elsewhere some points may have been dropped, but it
  // stays below 1/2.
  float score(Vec3f position, Vec3f normal) const;

  // Tensors "region/scored/...", sizes in the head; and back. Errors: missing tensors or keys, sizes that
  // disagree.
  void save(Tensors& tensors, Json& head) const;
  static ScoredPoints load(const Tensors& tensors, const Json& head);

 private:
  float radius() const;
  Data data_;
  PointIndex index_;
};

}  // namespace cei3d
