// SPDX-License-Identifier: Apache-2.0
// Light given by the user: an environment as image or lobes, rotated and scaled.
#pragma once

#include "core/compute/device.h"
#include "engine/session/requests.h"
#include "model/scene/scene.h"

namespace cei3d {

// Cache of the lobes fitted to images, by content; empty folder: no cache.
struct LightCache {
  std::filesystem::path folder;
  bool writable = false;
};

// The environment as lobes, before rotation and scale. up: of the capture, unit. Errors: unreadable, a image
// that is not twice as wide as high, holds NaN or has no light in it, lobes that are not rows of 7.
SgMixture environment_light(const Device&, const LightChoice&, Vec3d up, const LightCache& = {});

// Light rotated about the up axis (degrees, counter-clockwise seen from above) and scaled.
SgMixture turned_light(const SgMixture&, double degrees, double scale, Vec3d up);
// Usage errors: an angle that is not finite, a scale that is not positive.
void check_turn(const LightChoice&);

// The chosen light, rotated and scaled. own: the light of the scene.
SgMixture chosen_light(const Device&, const LightChoice&, const SgMixture& own, Vec3d up,
                       const LightCache& = {});

}  // namespace cei3d
