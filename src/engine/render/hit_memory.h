// SPDX-License-Identifier: Apache-2.0
// What a frame leaves behind for the next one of the same buffer: how its hits were lit and their residuals.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "engine/render/scene_light.h"

namespace cei3d {

struct HitMemory {
  std::optional<LitHits> lit;                // none: no frame yet
  std::shared_ptr<const Residual> residual;  // that the values below are of
  std::vector<Vec3f> residuals;              // #hits; meaningful where has_residual is 1
  std::vector<uint8_t> has_residual;         // #hits
};

}  // namespace cei3d
