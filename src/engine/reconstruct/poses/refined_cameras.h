// SPDX-License-Identifier: Apache-2.0
// Poses and focal lengths of the training cameras between the unit frame, where they are changed, and the
// capture's.
#pragma once

#include <span>
#include <vector>

#include "model/scene/normalization.h"
#include "model/scene/view.h"

namespace cei3d {

// given, cameras: of the training views of the capture, in its order, as they were and as they are; unit
// frame. All have changed their focal length by the same factor.
RefinedCameras refined_cameras(const Capture&, std::span<const Camera> given, std::span<const Camera> cameras,
                               const Normalization&);
// The inverse: the given cameras with these poses and focal lengths, as many and in the same order. Error:
// another number.
std::vector<Camera> refined(std::vector<Camera> given, const RefinedCameras&, const Normalization&);

bool same_cameras(std::span<const Camera>, std::span<const Camera>);  // poses, focal lengths; bit for bit

// Whether photographs can be resampled as before when the focal length changes: not those of fisheye lenses,
// whose form no other focal length has.
bool can_change_focal(const Capture&);

}  // namespace cei3d
