// SPDX-License-Identifier: Apache-2.0
// From which sides the cameras see the object.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "engine/capture/check.h"
#include "model/scene/view.h"

namespace cei3d {

inline constexpr double kSeenWithin = 30;  // degrees

// Directions from the object, compared with those to the cameras.
struct SeenSides {
  double share = 0;       // of all directions, within kSeenWithin of a camera
  double gap = 0;         // degrees from the direction that is farthest from all cameras to the nearest one
  Vec3d unseen{0, 0, 1};  // the direction farthest from all cameras, unit, capture frame
};
// cameras: directions from the object to them, unit. Over the directions that are `wanted`, none: over all.
SeenSides seen_sides(std::span<const Vec3d> cameras, const std::function<bool(Vec3d)>& wanted = {});
// Of the training views.
SeenSides seen_sides(const Capture& capture, Vec3d center);

// Finds sides of the object that no training view faces. Undersides are none of them: most objects stand on
// one. center: of the object.
void check_coverage(const Capture& capture, Vec3d center, std::vector<Finding>& findings);

}  // namespace cei3d
