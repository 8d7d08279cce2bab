// SPDX-License-Identifier: Apache-2.0
// The surface after the light is known: reflections tell normals better than the radiance network does, which
// can blame its colors. The field is moved by what the shading model says about its normals, while the
// geometry stage's own loss holds the silhouettes. See docs/method.md#polishing.
#pragma once

#include "core/base/clock.h"
#include "core/base/progress.h"
#include "engine/reconstruct/appearance/appearance_stage.h"
#include "engine/reconstruct/geometry/geometry_stage.h"

namespace cei3d {

struct PolishOptions {
  int steps = 400;
  double seconds = 0;  // > 0: at most so long
  Clock clock = steady_seconds;
  int batch = 8192;  // hits a step
  float weight = 1;  // of the shading loss against the geometry stage's
  double from =
      0.66;  // where in the geometry stage's schedule, whose rates it takes, it begins; it ends with it
  uint64_t seed = 1;
  int64_t first_step =
      int64_t(1) << 24;  // number of the first of the geometry stage's steps: its random rays
};

// input: the surface as the stage left it, and its hits. appearance: of that surface; light and material
// stay, its albedo follows in a copy that is thrown away.
void polish_surface(const Device&, GeometryStage&, const AppearanceInput& input,
                    const AppearanceResult& appearance, const PolishOptions&, Progress&);

}  // namespace cei3d
