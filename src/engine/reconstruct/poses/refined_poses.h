// SPDX-License-Identifier: Apache-2.0
// Poses of the training cameras between the unit frame, where they are moved, and the capture's.
#pragma once

#include <span>
#include <vector>

#include "model/scene/normalization.h"
#include "model/scene/view.h"

namespace cei3d {

// cameras: of the training views of the capture, in its order; unit frame.
std::vector<RefinedPose> refined_poses(const Capture&, std::span<const Camera> cameras, const Normalization&);
// The inverse: the cameras with these poses, as many and in the same order. Error: another number.
std::vector<Camera> posed_cameras(std::vector<Camera> cameras, std::span<const RefinedPose>,
                                  const Normalization&);

bool same_poses(std::span<const Camera>, std::span<const Camera>);  // bit for bit

}  // namespace cei3d
