// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/reconstruct.h"

#include "core/base/json.h"
#include "engine/reconstruct/preset_settings.h"
#include "engine/reconstruct/reconstruct_with.h"
#include "engine/reconstruct/stages.h"

namespace cei3d {

namespace {

// Null for a run by steps, which is a function of its seed alone.
Json rates_of(const ReconstructInputs& in, const Preset& preset, const PixelStore& pixels,
              const std::optional<SavedRun>& saved, const Progress& progress) {
  if (in.options.seconds <= 0 || in.options.iterations > 0) return {};
  if (saved && !saved->position.rates.is_null()) return saved->position.rates;
  return to_json(in.rates ? *in.rates : measure_rates(in.device, preset, pixels, in.clock, progress));
}

std::optional<SavedRun> read_saved(const ReconstructInputs& in, const Preset& preset,
                                   const PixelStore& pixels, Checkpoints& checkpoints) {
  const auto state = checkpoints.latest();
  if (!state) return std::nullopt;
  return read_checkpoint(*state, [&] {
    return std::make_unique<GeometryStage>(in.device, pixels, preset.geometry, in.options.seed);
  });
}

Plan make_plan(const ReconstructInputs& in, const Preset& preset, const PixelStore& store, const Json& rates,
               Progress& progress) {
  const PlannedPixels pixels = planned_pixels(store);
  const Plan plan = plan_of(in.options, preset, pixels, rates.is_null() ? Rates() : rates_from_json(rates));
  Json line{{"stage", "plan"}, {"pixels", pixels.count}, {"plan", to_json(plan)}, {"rates", rates}};
  progress.log(line.dump());
  return plan;
}

}  // namespace

Scene reconstruct(const ReconstructInputs& in, Checkpoints& checkpoints, Progress& listener) {
  RunClock progress(listener, in.clock, in.options.iterations > 0 ? 0 : in.options.seconds);
  progress.enter("loading", 0, 0);
  TrainingViews views = load_training_views(in.capture, in.images, in.normalization, progress);
  Preset preset = in.preset;
  fit_to_footprint(preset, views.footprint);
  preset_settings().put(in.options.set, preset);
  std::optional<SavedRun> saved = read_saved(in, preset, views.train, checkpoints);
  const Json rates = rates_of(in, preset, views.train, saved, progress);
  if (saved) progress.resume_at(saved->position.elapsed);
  LivePicture live(views.train.cameras().front(), in.show, in.clock);
  const RunContext context{.device = in.device,
                           .capture = in.capture,
                           .images = in.images,
                           .normalization = in.normalization,
                           .views = views,
                           .preset = preset,
                           .plan = make_plan(in, preset, views.train, rates, progress),
                           .seed = in.options.seed,
                           .light = in.options.light,
                           .light_color = in.options.light_color,
                           .refine_poses = in.options.refine_poses,
                           .fit_exposures = in.options.fit_exposures,
                           .progress = progress,
                           .live = live};
  RunState state = saved ? std::move(saved->state) : RunState();
  if (!state.scene.refined.poses.empty()) views.set_cameras(state.scene.refined, in.normalization);
  views.train.set_exposures(exposures_of(state));
  state.scene.normalization = in.normalization;
  state.scene.up = in.capture.up;
  StageRunner(context, rates, checkpoints)
      .run(stages_of(context.plan), state, saved ? std::optional(saved->position) : std::nullopt);
  listener.report({"done", 1, 0, ""});
  return std::move(state.scene);
}

Scene reconstruct(const Device& device, const Capture& capture, const ImageSource& images,
                  const Normalization& normalization, const ReconstructOptions& options,
                  Checkpoints& checkpoints, Progress& progress, ShowPicture show) {
  return reconstruct({.device = device,
                      .capture = capture,
                      .images = images,
                      .normalization = normalization,
                      .options = options,
                      .preset = preset_by_name(options.preset),
                      .show = std::move(show)},
                     checkpoints, progress);
}

}  // namespace cei3d
