// SPDX-License-Identifier: Apache-2.0
// The similarity that puts the object into the unit sphere, from the silhouettes of the training views.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/geometry/shape/visual_hull.h"
#include "model/scene/normalization.h"
#include "model/scene/view.h"

namespace cei3d {

inline constexpr double kObjectRadius = 0.9;  // of the hull's bounding sphere after normalization

// Loads the training masks (on all threads). Errors: as normalization_from_masks; unreadable pictures.
Normalization find_normalization(const Capture& capture);

// masks: cameras in the input frame. A box from rays through the silhouettes' centers and their widths, a
// coarse hull in it, a finer one in the coarse hull's box; the transform puts that one's bounding sphere to
// radius kObjectRadius. Some wrong masks (one in twenty) are outvoted, and a sentence about it is added to
// warnings. region (input frame): what lies outside is no part of the object; pictures that cut it off leave
// a hull far too large otherwise. One that holds none of the hull is not believed, with a warning. Errors:
// fewer than two views with a silhouette, all cameras on a line with the object, an empty hull (masks and
// poses disagree).
Normalization normalization_from_masks(std::span<const HullMask> masks,
                                       std::vector<std::string>* warnings = nullptr,
                                       const std::optional<ObjectBall>& region = {});

// The point nearest to all lines (least squares), NaN when the lines don't say. directions: unit.
Vec3d nearest_point_to_lines(std::span<const Vec3d> origins, std::span<const Vec3d> directions);

}  // namespace cei3d
