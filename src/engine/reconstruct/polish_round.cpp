// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/polish_round.h"

#include <algorithm>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/json.h"
#include "engine/reconstruct/appearance/shaded_samples.h"
#include "engine/reconstruct/appearance/surface_polish.h"
#include "engine/reconstruct/stage_inputs.h"
#include "engine/reconstruct/view_brightness.h"

namespace cei3d {
namespace {

constexpr double kFullEffort = 2;  // the appearance stage at full effort, in times of a brief estimate
constexpr double kMaxLent = 0.5;   // of what polishing has left
constexpr double kMinPolishShare = 1.0 / 6;  // of a descent's planned time
constexpr size_t kCompared = 300000;         // hits, about, by which photographs are compared
// Spread of the photographs' brightness that counts. Where exposures are equal it is .02 at most, for a
// metal.
constexpr double kMinBrightness = 0.05;

// Sets the end of all rounds in the first.
bool has_time(const RunContext& run, RunState& state, int round) {
  const Plan& plan = run.plan;
  const double now = run.progress.elapsed();
  if (round == 0) {
    state.polish_deadline = now + plan.polish_rounds * (plan.polish + plan.look);
    state.look_seconds = plan.look;
    return true;
  }
  const double look = state.look_seconds;
  return plan.polish <= 0 || worth_a_look(state.polish_deadline - now - look, look, plan.polish);
}

// Every n-th hit with what light and material make of it.
std::vector<ComparedSample> compared(const RunContext& run, const RunState& state, const LightTurns* turns,
                                     const Transport& transport) {
  ObjectHits some;
  const ObjectHits& all = state.hits;
  for (size_t i = 0; i < all.hits.size(); i += std::max<size_t>(1, all.hits.size() / kCompared)) {
    some.hits.push_back(all.hits[i]);
    some.colors.push_back(all.colors[i]);
    some.views.push_back(all.views[i]);
    some.footprints.push_back(all.footprints[i]);
  }
  const SampleShader shader(run.device, state.scene, turns, run.progress, &transport);
  const std::vector<Vec3f> radiance = shader.radiance(some.samples(turns), run.progress);
  std::vector<ComparedSample> out;
  for (size_t i = 0; i < radiance.size(); ++i)
    out.push_back({some.hits[i].position, some.views[i], some.colors[i], radiance[i]});
  return out;
}

// What the radiance network has learned with the colors, so that it could not tell it.
void fit_brightness(const RunContext& run, RunState& state, const LightTurns* turns,
                    const Transport& transport) {
  const size_t views = run.views.train.cameras().size();
  const std::vector<float> factors = view_brightness(compared(run, state, turns, transport), views);
  double squares = 0;
  for (const float f : factors) squares += square(std::log(double(f)));
  const double spread = std::sqrt(squares / double(views));
  run.progress.log(Json{{"stage", "brightness of views"}, {"spread", spread}}.dump());
  if (spread < kMinBrightness) return;
  state.brightness.resize(views, 1);
  for (size_t v = 0; v < views; ++v) state.brightness[v] *= factors[v];
  run.views.train.set_exposures(exposures_of(state));
  state.hits = {};  // have the colors of before
}

// Estimates light and material of the present surface. Until the round ends the scene holds them and the
// field and surface that they belong to, so that its checkpoints do.
void estimate(const RunContext& run, RunState& state, int round) {
  const double begin = run.progress.elapsed();
  const Field& sdf = state.geometry->sdf();
  SurfaceAndHits all = extract_surface_and_hits(run.device, sdf, run.preset.meshing, run.views.train,
                                                run.preset.max_hits, run.progress);
  AppearanceOptions brief = run.preset.appearance;
  brief.effort = Effort::brief;
  brief.seed = run.seed;
  brief.light_color = run.light_color;
  brief.several_materials = state.several_materials;
  const double motion_begin = run.progress.elapsed();
  const Turns turns = light_turns(run, state, all.surface, all.hits);
  const double fit_begin = run.progress.elapsed();
  AppearanceInput input{all.surface, all.hits.samples(turns.get())};
  input.transport = transport_of(input, run.progress);
  AppearanceResult made = fit_appearance(run.device, input, brief, run.progress);
  check_cancelled(run.progress);
  const double now = run.progress.elapsed();
  if (round == 0)
    state.polish_deadline -= seconds_lent(run.plan, now - fit_begin, state.polish_deadline - now);
  Scene& scene = state.scene;
  scene.sdf = std::make_shared<const Field>(sdf);
  scene.surface = std::move(all.surface);
  scene.light = std::move(made.light);
  scene.material = made.material;
  scene.albedo = std::move(made.albedo);
  state.several_materials = scene.material.varying() != nullptr;
  state.hits = std::move(all.hits);
  if (run.fit_exposures) fit_brightness(run, state, turns.get(), *input.transport);
  // Later rounds know how the light moves.
  state.look_seconds = run.progress.elapsed() - begin - (fit_begin - motion_begin);
}

void forget_estimate(RunState& state) {
  Scene& scene = state.scene;
  scene.sdf = scene.albedo = nullptr;
  scene.surface = nullptr;
  scene.light = {};
  scene.material = {};
  state.hits = {};
  state.descent = {};
  state.descent_seconds = 0;
}

// Of this round's descent, if the estimates of later rounds take as long as the one before it.
double seconds_of_descent(const RunContext& run, const RunState& state, int round) {
  const double begin = run.progress.elapsed() - state.descent_seconds;
  return std::max(std::min(1.0, run.plan.polish),
                  descent_seconds(state.polish_deadline - begin, run.plan.polish_rounds - round,
                                  state.look_seconds, run.plan.polish));
}

PolishOptions options_of(const RunContext& run, RunState& state, int round,
                         const Stage::Checkpoint& checkpoint) {
  PolishOptions options = run.preset.polish;
  options.steps = run.plan.polish_steps;
  options.seconds = run.plan.polish > 0 ? seconds_of_descent(run, state, round) : 0;
  options.spent = state.descent_seconds;
  options.clock = run.progress.clock();
  options.seed = run.seed + uint64_t(round);
  options.first_step = (int64_t(round) + 1) << 24;
  options.show = [&run, &geometry = *state.geometry] {
    run.live.offer([&](const Camera& camera) { return geometry.render_radiance(camera, 1); });
  };
  options.store = descent_store(run, state, &state.descent_seconds, checkpoint);
  return options;
}

}  // namespace

double seconds_lent(const Plan& plan, double brief_seconds, double left) {
  const double needed = plan.effort == Effort::full ? kFullEffort * brief_seconds : brief_seconds;
  return std::clamp(needed - plan.appearance, 0.0, std::max(0.0, kMaxLent * left));
}

bool worth_a_look(double seconds, double look, double planned) {
  return seconds >= std::clamp(look, kMinPolishShare * planned, planned);
}

double descent_seconds(double left, int rounds, double look, double planned) {
  const auto of_each = [&](int n) { return (left - (n - 1) * look) / n; };
  int kept = rounds;
  while (kept > 1 && !worth_a_look(of_each(kept), look, planned)) --kept;
  return std::min(of_each(kept), planned);
}

void polish(const RunContext& run, RunState& state, int round, const Stage::Checkpoint& checkpoint) {
  const bool begun = !state.descent.tensors.empty();
  if (!begun && !has_time(run, state, round)) return;
  if (!begun) estimate(run, state, round);
  find_hits(run, state);
  const Scene& scene = state.scene;
  const Turns turns = light_turns(run, state, scene.surface, state.hits);
  polish_surface(run.device, *state.geometry, {scene.surface, state.hits.samples(turns.get())},
                 {scene.light, scene.material, scene.albedo, {}}, options_of(run, state, round, checkpoint),
                 run.progress);
  forget_estimate(state);
  run.progress.log(Json{{"stage", "polish"}, {"look_seconds", state.look_seconds}}.dump());
}

}  // namespace cei3d
