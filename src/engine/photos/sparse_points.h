// SPDX-License-Identifier: Apache-2.0
// The points that were triangulated with the poses, and which of them are on the object.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/vec2.h"
#include "model/scene/view.h"

namespace cei3d {

struct SparsePoints {
  std::vector<Vec3d> positions;  // capture frame
  struct Observation {
    uint32_t point;
    Vec2f pixel;  // of the photograph
  };
  std::vector<std::vector<Observation>> views;  // one for each view: the points that it shows
};
SparsePoints sparse_points(std::span<const View> views);

// Where each point probably lies, #points: 1: on the object; -1: on the plane that the object lies on or
// hangs at, or far away; -0.5: on something else nearby; 0: not known.
using PointBelief = std::vector<float>;

// The object is what stands in the middle of what all cameras look at, above the plane that it lies on or
// hangs at, if there is one: a plane that holds many points, has none behind it and all cameras before it.
// center: the point nearest to the optical axes. Errors: the cameras all look the same way, no points.
struct PointSplit {
  PointBelief belief;
  Vec3d center;
  double radius = 0;  // of the ball about the center that the photographs show whole
  bool on_plane = false;
};
PointSplit split_points(const SparsePoints&, std::span<const View> views);

}  // namespace cei3d
