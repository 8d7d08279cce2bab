// SPDX-License-Identifier: Apache-2.0
// Light that users bring: an environment as picture or lobes, turned and scaled.
#pragma once

#include "core/compute/device.h"
#include "engine/session/requests.h"
#include "model/scene/scene.h"

namespace cei3d {

// Where fits of pictures are kept, by content; an empty folder: nowhere.
struct LightCache {
  std::filesystem::path folder;
  bool writable = false;
};

// The choice's environment as lobes, not yet turned or scaled. up: of the capture. Errors: unreadable, a
// picture that is not twice as wide as high, holds NaN or has no light in it, lobes that are not rows of 7.
SgMixture environment_light(const Device&, const LightChoice&, Vec3d up, const LightCache& = {});

// Counter-clockwise about the up axis, seen from above.
SgMixture turned_light(const SgMixture&, double degrees, double scale, Vec3d up);
// Usage errors: an angle that is not finite, a scale that is not positive.
void check_turn(const LightChoice&);

// All of it: the light that is asked for, in place of the scene's own.
SgMixture chosen_light(const Device&, const LightChoice&, const SgMixture& own, Vec3d up,
                       const LightCache& = {});

}  // namespace cei3d
