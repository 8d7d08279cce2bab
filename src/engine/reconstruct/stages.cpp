// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/stages.h"

#include <algorithm>

#include "core/base/cancel.h"
#include "core/base/json.h"
#include "engine/reconstruct/appearance/find_light_frame.h"
#include "engine/reconstruct/appearance/residual_images_fit.h"
#include "engine/reconstruct/coupled_stages.h"
#include "engine/reconstruct/geometry/silhouette_level.h"
#include "engine/reconstruct/geometry_training.h"
#include "engine/reconstruct/joint/joint_run.h"
#include "engine/reconstruct/joint/joint_stage.h"
#include "engine/reconstruct/polish_round.h"
#include "engine/reconstruct/poses/refined_cameras.h"
#include "engine/reconstruct/stage_inputs.h"

namespace cei3d {

namespace {

// Number of a random subset of the pixels; the albedo's refinements take 1, 2, ...
constexpr uint64_t kJointSubset = 1001;
// Share of the joint stage's time that is descent; the rest is hits, a mesh and the judgment.
constexpr double kJointDescentShare = 0.7;
constexpr double kMinJointGain = 0.02;  // dB on pixels that the joint descent does not see
constexpr float kMaxLevel = 0.002f;  // maximum shift of the zero level: the thickness of the sharpest density
constexpr double kLightShare = 0.6;  // share of light in the planned time of light and appearance

// Lengths of the stages of a run by steps, in steps of the geometry stage.
constexpr double kStartSteps = 50, kTrialsSteps = 1500, kLookSteps = 350, kSurfaceSteps = 80,
                 kAppearanceSteps = 600, kFinerMeshSteps = 400, kPolishStepLength = 3, kJointStepLength = 2,
                 kResidualSteps = 300, kColorStepLength = 0.4;

// How the light turns in the training views, found on the visual hull if it is not given: the diffuse shading
// of a rough shape mostly suffices.
LightFrame first_light_frame(const RunContext& run) {
  constexpr int kCells = 96;
  constexpr size_t kHits = 100000;
  const std::vector<Camera>& cameras = run.views.train.cameras();
  const Vec3f axis = turntable_axis(run);
  if (run.light) return light_frame(*run.light, cameras, axis);
  run.progress.report({"light", 0, -1, ""});
  const PixelStore& pixels = run.views.train;
  GeometryStage rough(run.device, pixels, run.preset.trial.geometry, run.seed);
  rough.prefit(start_shape(pixels, Start::hull, run.seed, run.preset.trial.shapes, run.progress),
               run.progress);
  MeshingOptions coarse = run.preset.meshing;
  coarse.resolution = std::min(coarse.resolution, kCells);
  const SurfaceAndHits hull =
      extract_surface_and_hits(run.device, rough.sdf(), coarse, pixels, kHits, run.progress);
  return find_light_frame(hull.input(nullptr), hull.hits.views, cameras, axis, {run.seed, false},
                          run.progress);
}

void begin_as_sphere(const RunContext& run, RunState& state) {
  const PixelStore& pixels = run.views.train;
  if (run.light) state.scene.light_frame = light_frame(*run.light, pixels.cameras(), turntable_axis(run));
  state.light_frame_known = run.light.has_value();
  state.geometry = std::make_unique<GeometryStage>(run.device, pixels, run.preset.geometry, run.seed);
  state.geometry->set_light(state.scene.light_frame);
  state.geometry->begin_as_sphere(run.preset.start_radius);
}

void make_start(const RunContext& run, RunState& state, const Stage::Checkpoint&) {
  if (run.preset.start == StartChoice::sphere) return begin_as_sphere(run, state);
  PixelStore& pixels = run.views.train;
  const double begin = run.progress.now();
  TrialOptions trial = run.preset.trial;
  trial.light = state.scene.light_frame = first_light_frame(run);
  state.light_frame_known = run.light || trial.light.motion != LightMotion::world;
  if (run.plan.trial_steps > 0) trial.steps = run.plan.trial_steps;
  trial.hull_alone = run.plan.hull_alone;
  trial.align = run.refine_poses;
  trial.align_seconds = run.plan.alignment;
  trial.clock = run.progress.clock();
  if (!can_change_focal(run.capture)) trial.focal_error = 0;
  if (run.fit_exposures) trial.exposures = run.views.noted_exposures;
  const std::vector<Camera> given = pixels.cameras();
  const StartShape start = run.plan.trial_steps > 0
                               ? choose_start(run.device, pixels, trial, run.seed, run.progress)
                               : start_shape(pixels, run.plan.start, run.seed, trial.shapes, run.progress);
  if (!same_cameras(pixels.cameras(), given)) keep_cameras(run, state);
  if (!pixels.exposures().empty()) keep_exposures(run, state);
  const double chosen = run.progress.now();
  state.start_seconds = chosen - begin;
  state.geometry = std::make_unique<GeometryStage>(run.device, pixels, run.preset.geometry, run.seed);
  state.geometry->set_light(state.scene.light_frame);
  state.geometry->prefit(start, run.progress);
  run.progress.log(Json{{"stage", "prefit"}, {"seconds", run.progress.now() - chosen}}.dump());
}

void run_geometry(const RunContext& run, RunState& state, const Stage::Checkpoint& checkpoint) {
  train_geometry(run, state, checkpoint);
  log_radiance_psnr(run, *state.geometry, state.scene.refined.focal);
  if (!run.progress.cancelled()) return;
  checkpoint();
  check_cancelled(run.progress);
}

// Shifts the field so that the surface of the silhouettes becomes its zero level.
Field at_silhouettes(const RunContext& run, Field sdf) {
  const float level = silhouette_level(run.device, sdf, run.views.train, kMaxLevel, run.seed, run.progress);
  sdf.params().all().back().value[0] -= level;  // the last layer's bias
  run.progress.log(Json{{"stage", "silhouettes"}, {"level", level}}.dump());
  return sdf;
}

void make_surface(const RunContext& run, RunState& state, const Stage::Checkpoint&) {
  Scene& scene = state.scene;
  scene.sdf = std::make_shared<const Field>(at_silhouettes(run, state.geometry->sdf()));
  state.geometry.reset();
  run.progress.report({"mesh", 0.2, -1, ""});
  SurfaceAndHits made = extract_surface_and_hits(run.device, *scene.sdf, run.preset.meshing, run.views.train,
                                                 run.preset.max_hits, run.progress);
  scene.surface = std::move(made.surface);
  state.hits = std::move(made.hits);
  run.progress.report({"handler points", 0.8, -1, ""});
  scene.handlers = handlers_of(state.hits, run.views.footprint);
}

AppearanceOptions appearance_options(const RunContext& run) {
  AppearanceOptions options = run.preset.appearance;
  options.effort = run.plan.effort;
  options.light_color = run.light_color;
  options.seed = run.seed;
  return options;
}

// What the stages of light, appearance and albedo see, which share the transport; it is computed again where
// a run is resumed between them.
AppearanceInput appearance_input(const RunContext& run, RunState& state, const ObjectHits& hits,
                                 const LightTurns* turns) {
  AppearanceInput input{state.scene.surface, hits.samples(turns), state.transport};
  state.transport = input.transport = transport_of(input, run.progress);
  return input;
}

// turns: must outlive the result.
ShowAppearance shown_on(const RunContext& run, const Scene& scene, const LightTurns* turns) {
  return [&run, &scene, turns](const Lighting& lighting, const Field& albedo, const MaterialField& material) {
    run.live.offer([&](const Camera& camera) {
      return lit_picture(run.device, {*scene.sdf, scene.surface, lighting, albedo, material, turns}, camera);
    });
  };
}

void estimate_light(const RunContext& run, RunState& state, const Stage::Checkpoint&) {
  Scene& scene = state.scene;
  find_hits(run, state);
  const Turns turns = light_turns(run, state, scene.surface, state.hits);
  AppearanceOptions options = appearance_options(run);
  options.several_materials = state.several_materials;
  AppearanceResult made = separate_light(run.device, appearance_input(run, state, state.hits, turns.get()),
                                         options, run.progress);
  check_cancelled(run.progress);
  scene.light = std::move(made.light);
  scene.light_error = relative_error(made.split.light_error);
  scene.material = made.material;
  state.separated_albedo = std::move(made.split.albedo);
  state.descent_share = affordable_descent(run.plan, run.progress.left());
}

void estimate_appearance(const RunContext& run, RunState& state, const Stage::Checkpoint& checkpoint) {
  Scene& scene = state.scene;
  find_hits(run, state);
  const Turns turns = light_turns(run, state, scene.surface, state.hits);
  AppearanceResult made{scene.light, scene.material, nullptr, {}};
  AppearanceOptions options = appearance_options(run);
  options.show = shown_on(run, scene, turns.get());
  options.descent_share = state.descent_share;
  descend_on_appearance(run.device, appearance_input(run, state, state.hits, turns.get()), options,
                        state.separated_albedo, made, run.progress,
                        descent_store(run, state, nullptr, checkpoint));
  check_cancelled(run.progress);
  state.descent = {};
  state.hits = {};
  state.separated_albedo.clear();
  scene.light = std::move(made.light);
  scene.material = made.material;
  scene.albedo = std::move(made.albedo);
}

// Skipped when time is short.
void refine(const RunContext& run, RunState& state, uint64_t subset) {
  const Plan& plan = run.plan;
  if (run.progress.left() < plan.refinement + plan.joint + plan.finer_mesh + plan.residual) return;
  Scene& scene = state.scene;
  const ObjectHits hits = scene_hits(run, scene, {run.preset.max_hits, subset});
  AppearanceResult result{scene.light, scene.material, scene.albedo, {}};
  const Turns turns = light_turns(run, state, scene.surface, hits);
  AppearanceOptions options = appearance_options(run);
  options.show = shown_on(run, scene, turns.get());
  refine_albedo(run.device, appearance_input(run, state, hits, turns.get()), options, result, run.progress,
                run.preset.refinement_steps);
  check_cancelled(run.progress);
  scene.albedo = std::move(result.albedo);
}

// The descent of the joint stage, from its checkpoint if it was interrupted.
JointObject joint_object(const RunContext& run, RunState& state, const AppearanceInput& input,
                         const Stage::Checkpoint& checkpoint) {
  const Scene& scene = state.scene;
  JointStageOptions options{run.preset.joint, run.plan.joint_steps, kJointDescentShare * run.plan.joint,
                            run.progress.clock(), shown_on(run, scene, input.samples.turned.turns)};
  options.descent.seed = run.seed;
  options.spent = state.descent_seconds;
  options.store = descent_store(run, state, &state.descent_seconds, checkpoint);
  // Before the first step there is nothing to go on from, and what was stored differs from the scene in the
  // last bit.
  if (state.descent.step == 0) options.store.from = {};
  return descend_jointly(run.device, input, run.views.train,
                         {*scene.sdf, *scene.albedo, scene.material, scene.light}, options, run.progress);
}

// Descends on everything at once, and keeps the result if it explains pixels better that the descent has not
// seen.
void descend_on_all(const RunContext& run, RunState& state, const Stage::Checkpoint& checkpoint) {
  const Plan& plan = run.plan;
  const bool begun = !state.descent.tensors.empty();
  if (!begun && run.progress.left() < plan.joint + plan.finer_mesh + plan.residual) return;
  Scene& scene = state.scene;
  const ObjectHits hits = scene_hits(run, scene, {run.preset.max_hits, kJointSubset});
  const Turns turns = light_turns(run, state, scene.surface, hits);
  const SurfaceSamples samples = hits.samples(turns.get());
  JointObject made = joint_object(run, state, {scene.surface, samples}, checkpoint);
  Scene after = scene;
  after.sdf = std::make_shared<const Field>(std::move(made.sdf));
  after.albedo = std::make_shared<const Field>(std::move(made.albedo));
  after.material = made.material;
  after.light = std::move(made.light);
  after.surface = extract_surface(run.device, *after.sdf, run.preset.meshing, run.progress);
  const double before_psnr = held_out_psnr(run.device, scene, samples, run.progress),
               psnr = held_out_psnr(run.device, after, samples, run.progress);
  const bool kept = psnr > before_psnr + kMinJointGain;
  run.progress.log(Json{{"stage", "joint"}, {"before", before_psnr}, {"after", psnr}, {"kept", kept}}.dump());
  check_cancelled(run.progress);
  state.descent = {};
  state.descent_seconds = 0;
  if (!kept) return;
  after.handlers = handlers_of(scene_hits(run, after, {run.preset.max_hits}), run.views.footprint);
  scene = std::move(after);
}

// Skipped when the run is late.
void make_finer_mesh(const RunContext& run, RunState& state, const Stage::Checkpoint&) {
  state.transport = nullptr;  // of the coarser one; no later stage needs it
  if (!has_time_for_finer_mesh(run.plan, run.progress.left())) return;
  state.scene.surface = extract_surface(run.device, *state.scene.sdf, run.preset.finer_meshing, run.progress);
}

// Of the photographs as bright as they are: views between them are as bright as those around.
void make_residual_images(const RunContext& run, RunState& state, const Stage::Checkpoint&) {
  state.transport = nullptr;
  state.brightness.clear();
  run.views.train.set_exposures(exposures_of(state));
  const Plan& plan = run.plan;
  ResidualImagesOptions options;
  options.max_pixels = run.preset.max_residual_pixels;
  if (plan.residual > 0)
    options.seconds = seconds_of_residual(plan, run.progress.left());
  else
    options.max_pixels = plan.residual_pixels;
  options.clock = run.progress.clock();
  options.seed = run.seed;
  const auto turns = turns_of(state.scene.light_frame, run.views.train.cameras());
  const ResidualImagesFit fit =
      fit_residual_images(run.device, state.scene, run.views.train, turns.get(), options, run.progress);
  state.scene.explained = fit.explained;
  if (!fit.images) return;
  Residual residual;
  residual.images = fit.images;
  state.scene.residual = std::make_shared<const Residual>(std::move(residual));
}

// Lengths of the stages: those of the plan, or of a run by steps, estimated.
struct Budgets {
  double start, geometry, polish, surface, appearance, refinement, joint, finer_mesh, residual;
};

Budgets budgets_of(const Plan& p) {
  const double start = p.trial_steps > 0 ? 0.2 : 0.01;  // share of the geometry stage
  if (p.geometry > 0)
    return {.start = start * p.geometry,
            .geometry = (1 - start) * p.geometry,
            .polish = p.look + p.polish,
            .surface = 0.5 * p.reserve,
            .appearance = p.appearance,
            .refinement = p.refinement,
            .joint = p.joint,
            .finer_mesh = p.finer_mesh,
            .residual = p.residual};
  return {.start = kStartSteps + (p.trial_steps > 0 ? kTrialsSteps : 0),
          .geometry = double(p.iterations),
          .polish = kLookSteps + kPolishStepLength * p.polish_steps,
          .surface = kSurfaceSteps,
          .appearance = kAppearanceSteps,
          .refinement = 0,
          .joint = kJointStepLength * p.joint_steps,
          .finer_mesh = kFinerMeshSteps,
          .residual = p.color == ColorChoice::coupled ? kColorStepLength * p.residual_steps : kResidualSteps};
}

}  // namespace

std::vector<Stage> stages_of(const Plan& plan) {
  if (plan.stages == StageChoice::joint) return joint_stages(plan, make_finer_mesh);
  const Budgets budget = budgets_of(plan);
  std::vector<Stage> stages{{"start", budget.start, make_start}, {"geometry", budget.geometry, run_geometry}};
  for (int round = 0; round < plan.polish_rounds; ++round)
    stages.push_back({fmt::format("polish {}", round + 1), budget.polish,
                      [round](const RunContext& run, RunState& state, const Stage::Checkpoint& checkpoint) {
                        polish(run, state, round, checkpoint);
                      }});
  stages.push_back({"surface", budget.surface, make_surface});
  if (plan.color == ColorChoice::coupled) {
    for (Stage& s : coupled_stages(plan, budget.finer_mesh, budget.residual, make_finer_mesh))
      stages.push_back(std::move(s));
    return stages;
  }
  stages.push_back({"light", kLightShare * budget.appearance, estimate_light});
  stages.push_back({"appearance", (1 - kLightShare) * budget.appearance, estimate_appearance});
  for (int k = 1; k <= plan.refinements + plan.spare_refinements; ++k)
    stages.push_back({fmt::format("albedo {}", k), k <= plan.refinements ? budget.refinement : 0,
                      [k](const RunContext& run, RunState& state, const Stage::Checkpoint&) {
                        refine(run, state, uint64_t(k));
                      }});
  if (plan.joint_steps > 0) stages.push_back({"joint", budget.joint, descend_on_all});
  if (plan.has_finer_mesh) stages.push_back({"finer mesh", budget.finer_mesh, make_finer_mesh});
  if (plan.residual_pixels > 0) stages.push_back({"residual", budget.residual, make_residual_images});
  return stages;
}

}  // namespace cei3d
