// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/surface_polish.h"

#include <algorithm>

#include "engine/reconstruct/appearance/normal_grads.h"

namespace cei3d {

void polish_surface(const Device& device, GeometryStage& stage, const AppearanceInput& input,
                    const AppearanceResult& appearance, const PolishOptions& options, Progress& progress) {
  const double start = options.clock() - options.spent;
  NormalGrads grads(device, input, appearance, options, progress);
  const DescentStore& store = options.store;
  if (!store.from.tensors.empty()) grads.load(store.from.tensors);
  for (int step = int(store.from.step); step < options.steps; ++step) {
    store.between_steps(progress, [&] {
      DescentState state{step, {}};
      grads.save(state.tensors);
      return state;
    });
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
