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
// Of the lobe of a sun: a glow of some three degrees, for highlights and soft shadows.
inline constexpr float kSunSharpness = 1000;
// The light and a white sun, which is one narrow lobe.
SgMixture with_sun(const SgMixture&, const Sun&);
// Usage errors: an angle that is not finite, a scale that is not positive, a sun without direction or with a
// negative strength.
void check_choice(const LightChoice&);

// The chosen light, rotated and scaled, and its sun. own: the light of the scene.
SgMixture chosen_light(const Device&, const LightChoice&, const SgMixture& own, Vec3d up,
                       const LightCache& = {});

}  // namespace cei3d
