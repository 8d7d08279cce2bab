// SPDX-License-Identifier: Apache-2.0
// What a frame keeps for the next frame of the same buffer: the light on its hits and their
// corrections.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/render/scene_light.h"
#include "model/scene/appearance.h"

namespace cei3d {

// What was evaluated at some of the hits of a buffer.
struct SomeValues {
  std::vector<Vec3f> values;   // #hits, linear radiance; valid where `known` is 1
  std::vector<uint8_t> known;  // #hits
};

struct HitMemory {
  std::optional<LitHits> lit;                // none: no frame yet
  std::optional<AppearanceKey> shown;        // of the scene in `lit`
  std::shared_ptr<const Residual> residual;  // the correction that gave the following
  SomeValues residuals, smooth_residuals;    // see residual_at()
};

}  // namespace cei3d
