// SPDX-License-Identifier: Apache-2.0
// The similarity transform that puts the object into the unit sphere, from the silhouettes of the training
// views.
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

// Loads the training masks (all threads). Errors: those of normalization_from_masks(), unreadable images.
Normalization find_normalization(const Capture& capture);

// masks: cameras in the capture frame. First a box from the rays through the silhouettes' centers and their
// widths, then a coarse hull in it, then a finer one in the coarse hull's box, whose bounding sphere gets the
// radius kObjectRadius. Up to one wrong mask in twenty is tolerated, with a warning. region (capture frame):
// what lies outside is not part of the object; without it, images that cut the object off give a far too
// large hull. A region that contains none of the hull is ignored with a warning. Errors: fewer than two views
// with a silhouette, all cameras on one line with the object, an empty hull (masks and poses disagree).
Normalization normalization_from_masks(std::span<const HullMask> masks,
                                       std::vector<std::string>* warnings = nullptr,
                                       const std::optional<ObjectBall>& region = {});

// The point nearest to all lines (least squares); NaN when the lines do not determine it. directions: unit.
Vec3d nearest_point_to_lines(std::span<const Vec3d> origins, std::span<const Vec3d> directions);

}  // namespace cei3d
