// SPDX-License-Identifier: Apache-2.0
// Polishing: after light and material are known, the shading loss improves the normals of the field, which
// the radiance network of the geometry stage can compensate by its colors. The loss of the geometry stage
// keeps the silhouettes. See docs/method.md#polishing.
#pragma once

#include <functional>

#include "core/base/clock.h"
#include "core/base/progress.h"
#include "engine/reconstruct/appearance/appearance_stage.h"
#include "engine/reconstruct/geometry/geometry_stage.h"

namespace cei3d {

struct PolishOptions {
  int steps = 400;
  double seconds = 0;  // > 0: time limit
  Clock clock = steady_seconds;
  int batch = 8192;  // hits per step
  float weight = 1;  // of the shading loss against the loss of the geometry stage
  // Position in the schedule of the geometry stage at which polishing begins; it ends at 1.
  double from = 0.66;
  uint64_t seed = 1;
  int64_t first_step = int64_t(1) << 24;  // index of the first step, which keys the random rays
  std::function<void()> show{};           // called after each step; changes nothing; may be empty
  double spent = 0;                       // s of `seconds` that earlier parts of the round took
  DescentStore store{};                   // does not hold the GeometryStage, whose state its user saves
};

// input: the surface of the stage, and its hits. appearance: of that surface; light and material are fixed,
// the albedo is trained along in a copy that is discarded. Error: interrupted; within a step, without saving
// it.
void polish_surface(const Device&, GeometryStage&, const AppearanceInput& input,
                    const AppearanceResult& appearance, const PolishOptions&, Progress&);

}  // namespace cei3d
