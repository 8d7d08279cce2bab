// SPDX-License-Identifier: Apache-2.0
// A part of the object that was moved between two photographs, like a hinged lid: found by the masks.
// docs/method.md#masks-that-are-a-little-wrong
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "core/image/area.h"
#include "core/math/camera.h"
#include "engine/capture/mask_votes.h"

namespace cei3d {

struct MovedPart {
  size_t first = 0;     // index of the first view after the move
  bool earlier = true;  // more views show the object before the move
  // Their convex hull holds what the masks show of the part in either position, but for its thin ends.
  std::vector<Vec3d> place;
  std::vector<Vec3d> around;  // their convex hull holds these, too
  bool shown_by_most(size_t view) const { return (view < first) == earlier; }
};

// The pixels that show the convex hull of the points, which are all in front of the camera.
Area seen_hull(std::span<const Vec3d> points, const Camera&);

// masks: in the order in which the photographs were taken. None: the masks agree, or no single move explains
// why they do not.
std::optional<MovedPart> find_moved_part(const SmallMasks& masks);

}  // namespace cei3d
