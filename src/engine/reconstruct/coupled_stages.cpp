// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/coupled_stages.h"

#include <algorithm>

#include "core/base/cancel.h"
#include "core/math/loss.h"
#include "core/math/rng.h"
#include "engine/reconstruct/appearance/find_light_frame.h"
#include "engine/reconstruct/appearance/residual_fit.h"

namespace cei3d {
namespace {

constexpr uint64_t kColorSubset = 1000;  // of the pixels
constexpr int kMeanSteps = 400, kMeanBatch = 2048;

// Colors of selected parts are compared, and paint is blended, with the mean color; the network over position
// and direction is what the object shows, because its light is black.
void fit_color(const RunContext& run, RunState& state, const Stage::Checkpoint&) {
  Scene& scene = state.scene;
  const Plan& plan = run.plan;
  state.hits = {};
  const ObjectHits hits = object_hits(run.device, *scene.sdf, *scene.surface, run.views.train,
                                      {plan.residual_hits, kColorSubset}, run.progress);
  const auto turns = turns_of(scene.light_frame, run.views.train.cameras());
  const SurfaceSamples samples = hits.samples(turns.get());
  scene.light.lobes = {{{0, 0, 1}, 1, {0, 0, 0}}};
  scene.albedo = mean_colors(run.device, samples, run.preset.appearance.albedo, run.seed, run.progress);
  ResidualOptions options;
  options.seconds = plan.residual > 0 ? std::clamp(run.progress.left() - 0.5 * plan.reserve,
                                                   0.5 * plan.residual, plan.residual)
                                      : 0;
  options.clock = run.progress.clock();
  options.steps = plan.residual_steps;
  options.seed = run.seed;
  scene.residual = std::make_shared<const Residual>(
      fit_residual(run.device, scene.sdf, samples, {}, options, run.progress));
  check_cancelled(run.progress);
}

}  // namespace

std::vector<Stage> coupled_stages(const Plan& plan, double finer_mesh_length, double color_length,
                                  const Stage::Run& make_finer_mesh) {
  std::vector<Stage> stages;
  if (plan.has_finer_mesh) stages.push_back({"finer mesh", finer_mesh_length, make_finer_mesh});
  stages.push_back({"color", color_length, fit_color});
  return stages;
}

std::shared_ptr<const Field> mean_colors(const Device& device, const SurfaceSamples& samples,
                                         const FieldConfig& config, uint64_t seed, Progress& progress) {
  auto field = std::make_shared<Field>(config, seed);
  FieldTrainer trainer(*field, {});
  std::vector<Vec3f> x(kMeanBatch), colors(kMeanBatch);
  const auto loss = [&](int begin, int end, const float* out, float* d_out) {
    for (int i = begin; i < end; ++i)
      for (int c = 0; c < 3; ++c) {
        const int k = 3 * (i - begin) + c;
        d_out[k] = cross_entropy(out[k], clamp(colors[i][c], 0.0f, 1.0f)).gradient / float(kMeanBatch);
      }
  };
  for (int step = 0; step < kMeanSteps; ++step) {
    check_cancelled(progress);
    for (size_t i = 0; i < x.size(); ++i) {
      const uint32_t k = Rng(seed, uint64_t(step), i).below(uint32_t(samples.hits.size()));
      x[i] = samples.hits[k].position;
      colors[i] = samples.colors[k];
    }
    trainer.step(device, x, loss, 1 - float(step) / kMeanSteps);
  }
  return field;
}

}  // namespace cei3d
