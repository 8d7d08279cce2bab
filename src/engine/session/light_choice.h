// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/compute/device.h"
#include "engine/session/requests.h"
#include "model/scene/scene.h"

namespace cei3d {

// The light that is asked for, in place of the scene's own. up: of the capture. Errors: unreadable picture,
// one that is not twice as wide as high or has no light in it.
SgMixture chosen_light(const Device&, const LightChoice&, const SgMixture& own, Vec3d up);

}  // namespace cei3d
