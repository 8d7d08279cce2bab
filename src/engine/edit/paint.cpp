// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/paint.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include "core/base/error.h"
#include "core/math/rng.h"
#include "engine/edit/stroke.h"

namespace cei3d {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void check_request(const PaintRequest& r) {
  if (r.scribble.channels != 4)
    fail(
        "the scribble has no alpha channel; save it as RGBA, opaque where it paints and transparent "
        "elsewhere");
  if (r.scribble.width != r.camera.width || r.scribble.height != r.camera.height)
    fail("the scribble is {}x{} pixels, the view {}x{}; paint on a picture of the view's own size",
         r.scribble.width, r.scribble.height, r.camera.width, r.camera.height);
}

void check_stroke(const Stroke& s) {
  if (s.painted_pixels == 0) fail("nothing in the scribble is opaque; paint with alpha above one half");
  if (s.painted_pixels == s.missed_pixels)
    fail("none of the {} painted pixels is on the object as this view sees it; is it the right view?",
         s.painted_pixels);
}

// Cells of half a pixel on the finest level, a table that holds those on the stroke: borders between
// two colours stay as sharp as the scribble shows them.
FieldConfig branch_config(const Stroke& s) {
  std::vector<float> footprints = s.footprints;
  std::nth_element(footprints.begin(), footprints.begin() + footprints.size() / 2, footprints.end());
  const float pixel = footprints[footprints.size() / 2] * float(s.scale);
  FieldConfig c;
  c.encoding.levels = 8;
  c.encoding.base_resolution = 16;
  c.encoding.finest_resolution = int(clamp(4 / pixel, 64.0f, 4096.0f));
  c.encoding.log2_table = std::clamp(int(std::bit_width(s.hits.size())), 14, 16);
  c.hidden_layers = 1;
  c.width = 32;
  c.outputs = 3;
  c.output_activation = Activation::sigmoid;
  return c;
}

constexpr int kSteps = 400, kBatch = 2048;

// One batch, with replacement: a function of seed and step.
struct Batch {
  std::vector<Vec3f> x, target;

  Batch(const Stroke& s, uint64_t seed, int step) : x(kBatch), target(kBatch) {
    for (int i = 0; i < kBatch; ++i) {
      const uint32_t k = Rng(seed, step, i).below(uint32_t(s.hits.size()));
      x[i] = s.hits[k].position;
      target[i] = s.targets[k];
    }
  }
};

// d/d(out) of the mean cross entropy: with the sigmoid behind it, the slope before it is out - target, so
// that dark and saturated colours, where the sigmoid is flat, are learnt as fast as the others.
FieldTrainer::Loss cross_entropy(const std::vector<Vec3f>& target) {
  return [&target](int begin, int end, const float* out, float* d_out) {
    for (int i = begin; i < end; ++i)
      for (int c = 0; c < 3; ++c) {
        const int k = 3 * (i - begin) + c;
        d_out[k] = (out[k] - target[i][c]) / (max(out[k] * (1 - out[k]), 1e-6f) * float(kBatch));
      }
  };
}

std::shared_ptr<const Field> fit_branch(const Device& device, const Stroke& s, uint64_t seed,
                                        Progress& progress) {
  auto field = std::make_shared<Field>(branch_config(s), seed);
  FieldTrainer trainer(*field, {.encoding_rate = 2e-2f, .network_rate = 1e-2f});
  for (int step = 0; step < kSteps; ++step) {
    if (progress.cancelled())
      throw Error(ErrorCode::interrupted, "painting was interrupted; nothing was changed");
    const float fraction = float(step) / kSteps;
    const Batch batch(s, seed, step);
    trainer.step(device, batch.x, cross_entropy(batch.target), 0.5f * (1 + std::cos(kPi * fraction)) + 1e-3f);
    if (step % 40 == 0) progress.report({"paint", 0.2 + 0.8 * fraction, -1, ""});
  }
  return field;
}

void measure_branch(const Device& device, const Field& branch, const Stroke& s, PaintReport& report) {
  std::vector<Vec3f> x;
  std::vector<size_t> index;
  for (size_t i = 0; i < s.hits.size(); ++i) {
    if (s.coverage[i] < 0.5f) continue;
    x.push_back(s.hits[i].position);
    index.push_back(i);
  }
  std::vector<float> out(3 * x.size());
  branch.eval(device, x, out);
  double sum = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const float error = abs(out[3 * i + c] - s.targets[index[i]][c]);
      sum += error;
      report.max_error = max(report.max_error, error);
    }
  }
  report.mean_error = float(sum / double(std::max<size_t>(out.size(), 1)));
}

}  // namespace

PaintResult paint(const Device& device, const Scene& scene, const PaintRequest& request, Progress& progress) {
  check_request(request);
  PaintResult result;
  const double start = now();
  const Stroke stroke = trace_stroke(device, scene, request.camera, request.scribble);
  check_stroke(stroke);
  result.layer.id = request.id;
  result.layer.region = stroke_region(stroke);
  const double traced = now();
  progress.report({"paint", 0.2, -1, ""});
  result.layer.albedo = fit_branch(device, stroke, request.seed, progress);
  measure_branch(device, *result.layer.albedo, stroke, result.report);
  PaintReport& report = result.report;
  report.painted_pixels = stroke.painted_pixels;
  report.missed_pixels = stroke.missed_pixels;
  report.points = result.layer.region.points().positions.size();
  report.trace_seconds = traced - start;
  report.train_seconds = now() - traced;
  return result;
}

}  // namespace cei3d
