// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/surface_polish.h"

#include <algorithm>

#include "core/base/cancel.h"
#include "engine/reconstruct/appearance/normal_grads.h"

namespace cei3d {

void polish_surface(const Device& device, GeometryStage& stage, const AppearanceInput& input,
                    const AppearanceResult& appearance, const PolishOptions& options, Progress& progress) {
  const double start = options.clock();
  NormalGrads grads(device, input, appearance, options, progress);
  for (int step = 0; step < options.steps; ++step) {
    check_cancelled(progress);
    const double time = options.seconds > 0 ? (options.clock() - start) / options.seconds : 0;
    if (time >= 1) break;
    const double done = std::max(time, double(step) / options.steps);
    stage.step(options.first_step + step, options.from + (1 - options.from) * done,
               grads.at(stage.sdf(), step), progress);
    if (options.show) options.show();
    if (step % 20 == 0) progress.report({"surface by its reflections", double(step) / options.steps, -1, ""});
  }
}

}  // namespace cei3d
