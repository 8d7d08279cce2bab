// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/joint/joint_run.h"

#include <algorithm>

#include "engine/reconstruct/appearance/find_light_frame.h"
#include "engine/reconstruct/joint/joint_stage.h"
#include "engine/reconstruct/joint/start_values.h"

namespace cei3d {
namespace {

// Lengths of the stages of a run by steps, in steps of the descent.
constexpr double kSurfaceLength = 30, kFinerMeshLength = 60;

void keep(JointObject object, Scene& scene) {
  scene.sdf = std::make_shared<const Field>(std::move(object.sdf));
  scene.albedo = std::make_shared<const Field>(std::move(object.albedo));
  scene.material = object.material;
  scene.light = std::move(object.light);
}

// How the light moves has to be given: without a surface it cannot be found.
LightFrame given_light_frame(const RunContext& run) {
  if (!run.light) return {};
  return light_frame(*run.light, run.views.train.cameras(), to_float(normalize(run.capture.up)));
}

// Seconds of the whole descent, of which `spent` are over; 0: no limit. What came before it may have taken
// longer than planned.
double seconds_of(const RunContext& run, double spent) {
  const Plan& p = run.plan;
  if (p.joint <= 0) return 0;
  return std::max(1.0, std::min(spent + run.progress.left() - p.reserve - p.finer_mesh, p.joint));
}

void descend(const RunContext& run, RunState& state, const Stage::Checkpoint& checkpoint) {
  Scene& scene = state.scene;
  scene.light_frame = given_light_frame(run);
  state.light_frame_known = true;
  const PixelStore& pixels = run.views.train;
  const ObjectHits rays = object_rays(pixels, {run.preset.max_hits});
  const auto turns = turns_of(scene.light_frame, pixels.cameras());
  JointStageOptions options{run.preset.joint, run.plan.joint_steps, seconds_of(run, state.training_seconds),
                            run.progress.clock()};
  options.descent.seed = run.seed;
  options.spent = state.training_seconds;
  options.store = descent_store(run, state, &state.training_seconds, checkpoint);
  keep(descend_jointly(run.device, {nullptr, rays.samples(turns.get())}, pixels,
                       start_values(run.device, run.preset, run.seed), options, run.progress),
       scene);
  state.descent = {};
}

void make_surface(const RunContext& run, RunState& state, const Stage::Checkpoint&) {
  Scene& scene = state.scene;
  const SurfaceAndHits made = extract_surface_and_hits(run.device, *scene.sdf, run.preset.meshing,
                                                       run.views.train, run.preset.brief_hits, run.progress);
  scene.surface = made.surface;
  scene.handlers = handlers_of(made.hits, run.views.footprint);
}

}  // namespace

std::vector<Stage> joint_stages(const Plan& plan, const Stage::Run& make_finer_mesh) {
  const bool timed = plan.joint > 0;
  std::vector<Stage> stages{{"joint", timed ? plan.joint : double(plan.joint_steps), descend},
                            {"surface", timed ? plan.reserve : kSurfaceLength, make_surface}};
  if (plan.has_finer_mesh)
    stages.push_back({"finer mesh", timed ? plan.finer_mesh : kFinerMeshLength, make_finer_mesh});
  return stages;
}

}  // namespace cei3d
