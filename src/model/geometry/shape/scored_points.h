// SPDX-License-Identifier: Apache-2.0
// Handler points with a score in [0, 1], the degree to which they belong to a part. Scores are interpolated
// between points, and the border of the part is the level one half: smooth, and finer than the spacing of the
// points.
#pragma once

#include <vector>

#include "core/base/json_reader.h"
#include "core/base/tensors.h"
#include "core/math/vec.h"
#include "model/geometry/shape/point_index.h"

namespace cei3d {

class ScoredPoints {
 public:
  struct Data {
    std::vector<Vec3f> positions;  // #N, unit frame
    std::vector<Vec3f> normals;    // #N, unit, outward
    std::vector<float> scores;     // #N, [0, 1]; >= 1/2: in the part
    float spacing = 0;             // between neighboring points, unit frame
  };

  ScoredPoints() = default;  // every score is 0
  // Keeps only the points that can affect where score() >= 1/2.
  explicit ScoredPoints(const Data&);

  bool empty() const { return data_.positions.empty(); }
  const Data& data() const { return data_; }

  // Weighted mean score of the points within 2.5 spacings on the same side of the surface; 0 where there is
  // none. Exact where it is at least 1/2; elsewhere only known to be below 1/2, because points far from the
  // part are dropped.
  float score(Vec3f position, Vec3f normal) const;

  // Writes tensors "region/scored/...", sizes to the head. Errors of load(): missing tensors or keys, sizes
  // that disagree.
  void save(Tensors& tensors, Json& head) const;
  static ScoredPoints load(const Tensors& tensors, JsonReader head);

 private:
  float radius() const;
  Data data_;
  PointIndex index_;
};

}  // namespace cei3d
