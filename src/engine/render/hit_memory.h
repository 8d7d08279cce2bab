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

struct HitMemory {
  std::optional<LitHits> lit;                // none: no frame yet
  std::optional<AppearanceKey> shown;        // of the scene in `lit`
  std::shared_ptr<const Residual> residual;  // the correction that gave `residuals`
  std::vector<Vec3f> residuals;              // #hits, linear radiance; valid where has_residual is 1
  std::vector<uint8_t> has_residual;         // #hits
};

}  // namespace cei3d
