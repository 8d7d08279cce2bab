// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/reconstruct.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/base/error.h"
#include "core/math/color.h"
#include "engine/reconstruct/appearance/appearance_stage.h"
#include "engine/reconstruct/appearance/residual_fit.h"
#include "engine/reconstruct/appearance/surface_polish.h"
#include "engine/reconstruct/geometry/geometry_stage.h"
#include "engine/reconstruct/geometry/silhouette_level.h"
#include "engine/reconstruct/plan.h"
#include "engine/reconstruct/run_clock.h"
#include "engine/reconstruct/standing.h"
#include "engine/reconstruct/start/start.h"

namespace cei3d {

namespace {

constexpr int kRim = 6;  // pixels around the object that are trained on
constexpr double kCheckpointSeconds = 30;
constexpr uint64_t kResidualSubset = 1000;  // not those of the albedo's refinements
constexpr double kLongRun = 120;            // seconds of training from which two starts are tried,
constexpr int kLongRunSteps = 4000;         // or steps

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

struct TrainingViews {
  PixelStore train, held_out;
  double footprint = 0;  // of a pixel at the object's centre, mean over the views
};

TrainingViews load_views(const Capture& capture, const ImageSource& images,
                         const Normalization& normalization, Progress& progress) {
  TrainingViews v;
  int done = 0, trained = 0;
  for (const View& view : capture.views) {
    progress.report({"loading", 0.01 * done++ / double(capture.views.size()), -1, view.name});
    if (progress.cancelled()) throw Error(ErrorCode::interrupted, "interrupted while loading the pictures");
    const bool train = view.split == Split::train;
    if (!train && v.held_out.cameras().size() >= 8) continue;
    const Image image = images.load(view);
    Camera camera = normalization.unit_from_input(view.camera);
    const double shrink = double(image.width) / camera.width;  // pictures may come downscaled
    camera.width = image.width;
    camera.height = image.height;
    for (double* f : {&camera.fx, &camera.fy, &camera.cx, &camera.cy, &camera.skew}) *f *= shrink;
    (train ? v.train : v.held_out).add_view(camera, image, kRim);
    if (train) v.footprint += length(camera.center) / camera.fx, ++trained;
  }
  v.footprint /= std::max(trained, 1);
  return v;
}

// Where a run stands in its schedule: by iterations, or by the clock.
class Schedule {
 public:
  Schedule(double seconds, int iterations) : seconds_(seconds), iterations_(iterations), start_(now()) {}
  void resume_at(double elapsed) { start_ = now() - elapsed; }
  double elapsed() const { return now() - start_; }
  double position(int64_t step) const {
    return seconds_ > 0 ? elapsed() / seconds_ : double(step) / iterations_;
  }
  double seconds_left(double u) const {
    return seconds_ > 0 ? seconds_ - elapsed() : u > 0.01 ? elapsed() * (1 - u) / u : -1;
  }

 private:
  double seconds_;
  int iterations_;
  double start_;
};

// start: seconds that choosing it took, which a resumed run must not get for training.
void save_geometry(Checkpoints& checkpoints, const GeometryStage& stage, int64_t step, double elapsed,
                   double start) {
  Checkpoints::State state;
  state.head = {{"stage", "geometry"}, {"step", step}, {"elapsed", elapsed}, {"start", start}};
  stage.save(state.tensors);
  checkpoints.save(state);
}

// The geometry's last state is saved: what comes after it is done anew.
void stop_if_cancelled(const Progress& progress) {
  if (progress.cancelled())
    throw Error(ErrorCode::interrupted, "interrupted; the state is saved", "go on with --resume");
}

// Trains until the schedule is over.
void train_geometry(GeometryStage& stage, const StartShape& start, const TrainingViews& views,
                    Schedule schedule, double start_seconds, Checkpoints& checkpoints, Progress& progress) {
  int64_t step = 0;
  if (const auto state = checkpoints.latest()) {
    stage.load(state->tensors);
    step = state->head.at("step").get<int64_t>();
    schedule.resume_at(state->head.at("elapsed").get<double>());
  } else {
    progress.report({"visual hull", 0.01, -1, ""});
    stage.prefit(start);
    progress.log(Json{{"stage", "prefit"}, {"seconds", schedule.elapsed()}}.dump());
    schedule.resume_at(0);
  }
  const PixelStore& judged = views.held_out.pixels().empty() ? views.train : views.held_out;
  const char* label = views.held_out.pixels().empty() ? "train" : "held-out";
  double next_report = 2, next_look = 2, last_save = schedule.elapsed(), psnr = 0;
  GeometryStats sum;
  for (;; ++step) {
    const double u = schedule.position(step);
    if (u >= 1) break;
    if (progress.cancelled()) {
      save_geometry(checkpoints, stage, step, schedule.elapsed(), start_seconds);
      throw Error(ErrorCode::interrupted, "interrupted; the state is saved", "go on with --resume");
    }
    sum = stage.step(step, u);
    if (!std::isfinite(sum.color)) fail("training diverged at step {}: the loss is not a number", step);
    const double rays = double(sum.rays);
    if (schedule.elapsed() > next_look) {
      const double before = schedule.elapsed();
      psnr = stage.evaluate(judged, 4096, u).psnr();
      const double after = schedule.elapsed();
      next_look = after + std::max(2.0, 40 * (after - before));  // large networks take long to look at
      progress.log(Json{{"stage", "geometry"},
                        {"step", step},
                        {"u", u},
                        {"color", sum.color / rays},
                        {"mask", sum.mask / rays},
                        {"eikonal", sum.eikonal / double(std::max<int64_t>(sum.kept, 1))},
                        {"psnr", psnr},
                        {"on", label},
                        {"kept", double(sum.kept) / rays}}
                       .dump());
    }
    if (schedule.elapsed() > next_report) {
      progress.report(
          {"geometry", 0.02 + 0.7 * u, schedule.seconds_left(u),
           fmt::format("loss {:.4f}  {} {:.1f} dB at the object", sum.color / rays, label, psnr)});
      next_report = schedule.elapsed() + 2;
    }
    if (schedule.elapsed() - last_save > kCheckpointSeconds) {
      save_geometry(checkpoints, stage, step + 1, schedule.elapsed(), start_seconds);
      last_save = schedule.elapsed();
    }
  }
  save_geometry(checkpoints, stage, step, schedule.elapsed(), start_seconds);
}

// The radiance field's own pictures of the held-out views, for the record: what the physical model is
// measured against.
void report_radiance(GeometryStage& stage, const Capture& capture, const ImageSource& images,
                     const Normalization& normalization, Progress& progress) {
  constexpr size_t kViews = 8;     // spread evenly, as many of them as
  constexpr double kSeconds = 15;  // allow
  const double begin = now();
  std::vector<const View*> held_out;
  for (const View& view : capture.views)
    if (view.split != Split::train) held_out.push_back(&view);
  double sum = 0;
  int views = 0;
  for (size_t i = 0; i < held_out.size(); ++i) {
    if (i > 0 && i * kViews / held_out.size() == (i - 1) * kViews / held_out.size()) continue;
    if (now() - begin > kSeconds) break;
    const View& view = *held_out[i];
    const Image truth = images.load(view);
    if (truth.width != view.camera.width) return;
    const Image got = stage.render_radiance(normalization.unit_from_input(view.camera), 2);
    double error = 0;
    for (size_t k = 0; k < got.data.size() / 3; ++k)
      for (int c = 0; c < 3; ++c) {
        const float a = truth.data[4 * k + 3], want = srgb_from_linear(truth.data[4 * k + c]) * a + 1 - a;
        error += square(double(got.data[3 * k + c]) - want);
      }
    sum += -10 * std::log10(error / double(got.data.size()));
    ++views;
  }
  if (views)
    progress.log(
        Json{{"stage", "radiance field"}, {"held_out_psnr_on_white", sum / views}, {"views", views}}.dump());
}

// The field with the surface that the silhouettes show at its zero level.
Field at_silhouettes(const Device& device, Field sdf, const PixelStore& pixels, uint64_t seed,
                     Progress& progress) {
  constexpr float kMostShift = 0.002f;  // the shell of the sharpest density is about as thick
  const float level = silhouette_level(device, sdf, pixels, kMostShift, seed);
  sdf.params().all().back().value[0] -= level;  // the last layer's bias
  progress.log(Json{{"stage", "silhouettes"}, {"level", level}}.dump());
  return sdf;
}

// Light and material for the surface as it stands, the surface for them, and again.
void polish(const Device& device, GeometryStage& stage, const Preset& preset, const Plan& plan,
            const PixelStore& pixels, uint64_t seed, Progress& progress) {
  constexpr double kBrief = 5;  // seconds of the appearance stage: half its effort
  constexpr size_t kBriefHits = 300000;
  constexpr double kLeastRound = 10;  // seconds of polishing that are worth another look
  const bool timed = plan.polish > 0;
  const double deadline = now() + plan.rounds * (plan.polish + plan.between);
  double looking = plan.between;  // as long as the last look took: concave objects take longer than planned
  for (int round = 0; round < plan.rounds; ++round) {
    const double begin = now();
    if (timed && round > 0 && deadline - begin < looking + kLeastRound) return;
    progress.report({"surface by its reflections", 0.72, -1, ""});
    const Standing standing = stand(device, stage.sdf(), preset, pixels);
    const Standing fewer{standing.surface,
                         object_hits(device, stage.sdf(), *standing.surface, pixels, kBriefHits)};
    AppearanceOptions brief = preset.appearance;
    brief.seconds = kBrief;
    brief.seed = seed;
    const AppearanceResult look = fit_appearance(device, fewer.input(), brief, progress);
    looking = now() - begin;
    PolishOptions options = preset.polish;
    options.steps = plan.polish_steps;
    const int rounds_left = plan.rounds - round;
    const double left = (deadline - now() - (rounds_left - 1) * looking) / rounds_left;
    options.seconds = timed ? std::clamp(left, 1.0, plan.polish) : 0;
    options.seed = seed + uint64_t(round);
    options.first_step = (int64_t(round) + 1) << 24;
    const double polishing = now();
    polish_surface(device, stage, standing.input(), look, options, progress);
    progress.log(Json{{"stage", "polish"}, {"looking", looking}, {"seconds", now() - polishing}}.dump());
    stop_if_cancelled(progress);
  }
}

}  // namespace

Scene reconstruct(const Device& device, const Capture& capture, const ImageSource& images,
                  const Normalization& normalization, const ReconstructOptions& options,
                  Checkpoints& checkpoints, Progress& listener) {
  RunClock progress(listener, options.iterations > 0 ? 0 : options.seconds);
  Preset preset = preset_by_name(options.preset);
  TrainingViews views = load_views(capture, images, normalization, progress);
  if (views.train.pixels().empty()) fail("no training picture shows the object: every mask is empty");
  fit_to_footprint(preset, views.footprint);

  const Plan plan = plan_of(options, preset, views.train.pixels().size());
  Scene scene;
  scene.normalization = normalization;
  scene.up = capture.up;
  {
    const double begin = now();
    const auto saved = checkpoints.latest();
    if (saved) progress.resume_at(saved->head.value("start", 0.0) + saved->head.at("elapsed").get<double>());
    const bool long_run = plan.geometry > 0 ? plan.geometry >= kLongRun : plan.iterations >= kLongRunSteps;
    StartShape start;
    // Starts are compared by the quickest networks: what they tell holds for all.
    Preset quick = preset_by_name("fast");
    fit_to_footprint(quick, views.footprint);
    if (!saved)
      start = long_run ? choose_start(device, views.train, quick.geometry, options.seed, progress)
                       : start_shape(views.train, Start::hull, options.seed);
    const double start_seconds = saved ? saved->head.value("start", 0.0) : now() - begin;
    const double seconds = plan.geometry > 0 ? std::max(plan.geometry - start_seconds, 1.0) : 0;
    GeometryStage stage(device, views.train, preset.geometry, options.seed);
    train_geometry(stage, start, views, Schedule(seconds, plan.iterations), start_seconds, checkpoints,
                   progress);
    report_radiance(stage, capture, images, normalization, progress);
    polish(device, stage, preset, plan, views.train, options.seed, progress);
    scene.sdf = std::make_shared<const Field>(
        at_silhouettes(device, stage.sdf(), views.train, options.seed, progress));
  }
  progress.report({"surface", 0.74, -1, ""});
  Standing standing = stand(device, *scene.sdf, preset, views.train);
  scene.surface = standing.surface;
  progress.report({"handler points", 0.78, -1, ""});
  scene.handlers = std::make_shared<const HandlerPoints>(
      thin_hits(standing.hits.hits, standing.hits.footprints, 1.5f * float(views.footprint)));

  AppearanceOptions appearance = preset.appearance;
  appearance.seconds = plan.appearance;
  appearance.seed = options.seed;
  AppearanceResult result = fit_appearance(device, standing.input(), appearance, progress);
  stop_if_cancelled(progress);
  for (int round = 1; round <= plan.refinements; ++round) {
    if (progress.left() < plan.refinement + plan.finishing + plan.residual) break;
    standing.hits = {};  // not both at a time
    standing.hits =
        object_hits(device, *scene.sdf, *standing.surface, views.train, preset.most_hits, uint64_t(round));
    refine_albedo(device, standing.input(), appearance, result, progress);
    stop_if_cancelled(progress);
  }
  scene.light = std::move(result.light);
  scene.material = result.material;
  scene.albedo = std::move(result.albedo);
  standing.hits = {};  // no two meshes' at a time
  if (plan.finish) {
    progress.report({"finer mesh", 0.98, -1, ""});
    scene.surface = std::make_shared<const Surface>(extract_mesh(device, *scene.sdf, preset.finished));
    standing.surface = scene.surface;
    stop_if_cancelled(progress);
  }
  if (plan.residual_steps > 0) {
    ResidualOptions residual;
    // Late: half of it, which the training of residuals needs to be worth anything.
    const double left = progress.left() - 0.5 * plan.saving;
    residual.seconds = plan.residual > 0 ? std::clamp(left, 0.5 * plan.residual, plan.residual) : 0;
    residual.steps = plan.residual_steps;
    residual.seed = options.seed;
    standing.hits =
        object_hits(device, *scene.sdf, *scene.surface, views.train, plan.residual_hits, kResidualSubset);
    if (auto fitted =
            fit_residual(device, scene, standing.input().samples, standing.hits.views, residual, progress))
      scene.residual = std::make_shared<const Residual>(std::move(*fitted));
    stop_if_cancelled(progress);
  }
  progress.report({"done", 1, 0, ""});
  return scene;
}

}  // namespace cei3d
