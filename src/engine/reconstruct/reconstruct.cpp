// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/reconstruct.h"

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

}  // namespace

Scene reconstruct(const ReconstructInputs& in, Checkpoints& checkpoints, Progress& listener) {
  RunClock progress(listener, in.clock, in.options.iterations > 0 ? 0 : in.options.seconds);
  progress.enter("loading", 0, 0);
  const TrainingViews views = load_training_views(in.capture, in.images, in.normalization, progress);
  Preset preset = in.preset;
  fit_to_footprint(preset, views.footprint);

  std::optional<SavedRun> saved;
  if (const auto state = checkpoints.latest())
    saved = read_checkpoint(*state, [&] {
      return std::make_unique<GeometryStage>(in.device, views.train, preset.geometry, in.options.seed);
    });
  const Json rates = rates_of(in, preset, views.train, saved, progress);
  if (saved) progress.resume_at(saved->position.elapsed);

  const RunContext context{.device = in.device,
                           .capture = in.capture,
                           .images = in.images,
                           .normalization = in.normalization,
                           .views = views,
                           .preset = preset,
                           .plan = plan_of(in.options, preset, views.train.pixels().size(),
                                           rates.is_null() ? Rates() : rates_from_json(rates)),
                           .seed = in.options.seed,
                           .progress = progress};
  progress.log(Json{{"stage", "plan"}, {"plan", to_json(context.plan)}, {"rates", rates}}.dump());

  RunState state = saved ? std::move(saved->state) : RunState();
  state.scene.normalization = in.normalization;
  state.scene.up = in.capture.up;
  StageRunner(context, rates, checkpoints)
      .run(stages_of(context.plan), state, saved ? std::optional(saved->position) : std::nullopt);
  listener.report({"done", 1, 0, ""});
  return std::move(state.scene);
}

Scene reconstruct(const Device& device, const Capture& capture, const ImageSource& images,
                  const Normalization& normalization, const ReconstructOptions& options,
                  Checkpoints& checkpoints, Progress& progress) {
  return reconstruct({.device = device,
                      .capture = capture,
                      .images = images,
                      .normalization = normalization,
                      .options = options,
                      .preset = preset_by_name(options.preset)},
                     checkpoints, progress);
}

}  // namespace cei3d
