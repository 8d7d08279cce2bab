// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "engine/bench/bench.h"
#include "engine/capture/capture_images.h"
#include "engine/capture/normalize.h"
#include "engine/reconstruct/geometry/geometry_stage.h"
#include "engine/reconstruct/presets.h"
#include "engine/reconstruct/start/start.h"
#include "engine/session/stopwatch.h"
#include "engine/synthetic/picture.h"
#include "engine/synthetic/views.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr const char* kInterrupted = "The measurement was interrupted.";
constexpr int kRim = 6;            // as reconstruct() has it
constexpr double kPosition = 0.5;  // in the schedule: all hash levels in use, before the density is sharp

struct Subject {
  std::string name;
  PixelStore pixels;
  double footprint = 0;  // of a pixel at the object's center, mean over the views
};

void add_view(Subject& s, const Camera& unit_camera, const Image& image) {
  s.pixels.add_view(unit_camera, image, kRim);
  s.footprint += length(unit_camera.center) / unit_camera.fx;
}

Subject read_subject(const fs::path& path) {
  const Capture capture = load_capture(path);
  const Normalization normalization = find_normalization(capture);
  const std::vector<View> views = views_of(capture, Split::train);
  std::vector<Image> images(views.size());
  parallel_for(int(views.size()), [&](int i) { images[size_t(i)] = load_linear_rgba(views[size_t(i)]); });
  Subject s;
  s.name = fmt::format("{}, {} views of {} x {}", fs::path(path / "").parent_path().filename().string(),
                       views.size(), images[0].width, images[0].height);
  for (size_t i = 0; i < views.size(); ++i)
    add_view(s, normalization.unit_from_capture(views[i].camera), images[i]);
  s.footprint /= double(views.size());
  return s;
}

// A ball of many colors, seen from all around: used when no capture is available.
Subject made_up_subject() {
  constexpr int kViews = 24, kSize = 160;
  const Shape ball = ball_shape(0.7f);
  Subject s;
  s.name = fmt::format("a made-up ball, {} views of {} x {}", kViews, kSize, kSize);
  for (const Camera& camera : spread_cameras(kViews, lens_of_size(kSize, kSize)))
    add_view(s, camera, draw_unlit(*ball.body, camera, [](Vec3f p) {
               Vec3f color;
               for (int k = 0; k < 3; ++k) color[k] = 0.4f + 0.3f * std::sin(9 * p[k] + float(k));
               return color;
             }));
  s.footprint /= kViews;
  return s;
}

Subject subject_of(const fs::path& capture) {
  if (!capture.empty()) return read_subject(capture);
  const fs::path sample = "samples/spot";
  return fs::exists(sample / "transforms_train.json") ? read_subject(sample) : made_up_subject();
}

struct PartName {
  StepPart part;
  const char* name;
};
constexpr std::array<PartName, kStepParts> kParts{{{StepPart::march, "march and values"},
                                                   {StepPart::forward, "jets and colors, forward"},
                                                   {StepPart::backward, "backward"},
                                                   {StepPart::scatter, "encoding gradients"},
                                                   {StepPart::adam, "Adam"},
                                                   {StepPart::occupancy, "occupancy grid"}}};

// Microseconds of processor time a ray, block after block.
struct Samples {
  std::vector<double> rays_per_second, whole, rest;
  std::array<std::vector<double>, kStepParts> parts;
};

void measure_block(GeometryStage& stage, StepTimes& times, int steps, int64_t& step, Samples& out) {
  times.clear();
  Stopwatch watch;
  const double begin = StepTimes::process_seconds();
  int64_t rays = 0;
  for (int k = 0; k < steps; ++k) rays += stage.step(step++, kPosition).rays;
  const double per_ray = 1e6 / double(rays), all = StepTimes::process_seconds() - begin;
  out.rays_per_second.push_back(double(rays) / watch.lap());
  out.whole.push_back(all * per_ray);
  double sum = 0;
  for (size_t i = 0; i < kParts.size(); ++i) {
    const double seconds = times.seconds(kParts[i].part);
    out.parts[i].push_back(seconds * per_ray);
    sum += seconds;
  }
  out.rest.push_back((all - sum) * per_ray);
}

std::vector<BenchFigure> figures_of(const std::string& subject, const Samples& s) {
  const char* unit = "us/ray";
  std::vector<BenchFigure> figures{
      {"training", subject, "geometry stage, rays", "rays/s", true, spread_of(s.rays_per_second, true), {}}};
  const Spread whole = spread_of(s.whole, false);
  const std::string share = "the step";
  const auto add = [&](const std::string& name, const std::vector<double>& values) {
    const Spread spread = spread_of(values, false);
    figures.push_back({"training",
                       subject,
                       "processor time, " + name,
                       unit,
                       false,
                       spread,
                       {{share, spread.median / whole.median}}});
  };
  figures.push_back({"training", subject, "processor time, the step", unit, false, whole, {}});
  for (size_t i = 0; i < kParts.size(); ++i) add(kParts[i].name, s.parts[i]);
  add("the rest", s.rest);
  return figures;
}

}  // namespace

std::vector<BenchFigure> bench_training(const Device& device, const TrainingBench& options,
                                        Progress& progress) {
  progress.report({"training: photographs", 0.2, -1, ""});
  const Subject subject = subject_of(options.capture);
  if (subject.pixels.pixels().empty()) fail("No training photograph of {} shows the object.", subject.name);
  Preset preset = preset_by_name("fast");
  fit_to_footprint(preset, subject.footprint);
  preset.geometry.prefit_steps = std::min(preset.geometry.prefit_steps, 2 * options.warm_up);
  GeometryStage stage(device, subject.pixels, preset.geometry, 1);
  progress.report({"training: visual hull", 0.3, -1, ""});
  stage.prefit(start_shape(subject.pixels, Start::hull, 1));
  int64_t step = 0;
  while (step < options.warm_up) {
    check_cancelled(progress, kInterrupted);
    stage.step(step, kPosition * double(step) / options.warm_up);
    ++step;
  }
  StepTimes times;
  stage.time_into(&times);
  Samples samples;
  double seconds = options.seconds;
  for (Stopwatch watch; int(samples.whole.size()) < options.min_measurements || seconds > 0;) {
    check_cancelled(progress, kInterrupted);
    progress.report({"training", 0.5, -1, ""});
    measure_block(stage, times, options.block, step, samples);
    seconds -= watch.lap();
  }
  return figures_of(subject.name, samples);
}

}  // namespace cei3d
