// SPDX-License-Identifier: Apache-2.0
// Table of the sky's radiance over the direction, blurred by a lobe that is narrow beside those of rough
// surfaces: what a ray stands for that is one of a few for a whole lobe.
#pragma once

#include "core/compute/device.h"
#include "core/compute/kernels/lobes.h"
#include "engine/render/direction_map.h"

namespace cei3d {

DirectionMap radiance_map(const Device&, const LobePlanes&);

}  // namespace cei3d
