// SPDX-License-Identifier: Apache-2.0
// A region of the surface: the points within reach of an edited handler point, on the same side of the
// surface [paper sec. 4.2]. The reach follows the local spacing: docs/method.md#regions-and-routing.
//
// Points alone give an outline as soft as their reach. A region from a painted view therefore also holds the
// painted mask with the camera and the depths of that view: a point belongs to it only if that camera sees it
// inside the mask. The points select the surface, the mask is the border: as sharp as the scribble (alpha
// 0.5, interpolated between pixels), and hidden surfaces are not changed.
//
// A part of the object is a third kind: scored points (model/geometry/shape/scored_points.h).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/math/vec.h"
#include "model/geometry/shape/point_index.h"
#include "model/geometry/shape/projector.h"
#include "model/geometry/shape/scored_points.h"

namespace cei3d {

class Region {
 public:
  Region() = default;  // contains nothing
  struct Points {
    std::vector<Vec3f> positions;  // #N edited points (H+), unit frame
    std::vector<Vec3f> normals;    // #N, unit
    std::vector<float> reach;      // #N, unit frame
  };
  // projector empty: the points alone decide. No points: the mask alone decides.
  explicit Region(Points points, Projector projector = {});
  explicit Region(ScoredPoints part);

  // normal: unit, outward.
  bool contains(Vec3f position, Vec3f normal) const;
  // Share of the edit at a point: 1 inside, 0 outside, the mask's alpha where the mask is soft.
  float weight(Vec3f position, Vec3f normal) const;
  const Points& points() const { return data_->points; }
  const Projector& projector() const { return data_->projector; }
  const ScoredPoints& scored() const { return data_->scored; }  // empty: not a part

  // Writes tensors "region/..." and the rest to the head. Errors of load(): missing tensors or keys, sizes
  // that disagree.
  void save(Tensors& tensors, Json& head) const;
  static Region load(const Tensors& tensors, const Json& head, const std::string& what = "A region");

 private:
  struct Data {
    Points points;
    Projector projector;
    ScoredPoints scored;
    PointIndex index;
    float max_reach = 0;
  };
  std::shared_ptr<const Data> data_ = std::make_shared<const Data>();  // copies of a region share it
};

}  // namespace cei3d
