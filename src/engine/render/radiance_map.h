// SPDX-License-Identifier: Apache-2.0
// The sky's radiance by direction, as a table, blurred by a narrow lobe. A reflection lobe is sampled by a
// few rays (lobe_rays.h), and the blurred radiance is what one of them stands for: that of a part of the
// lobe.
#pragma once

#include "core/compute/device.h"
#include "core/compute/kernels/lobes.h"
#include "engine/render/direction_map.h"

namespace cei3d {

DirectionMap radiance_map(const Device&, const LobePlanes&);

}  // namespace cei3d
