// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/paint.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/base/cancel.h"
#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/math/quantile.h"
#include "core/math/rng.h"
#include "engine/edit/material.h"
#include "engine/edit/relearn.h"
#include "engine/render/scene_light.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

void check_scribble(const Scribble& s) {
  if (s.image.channels != 4)
    fail(
        "the scribble has no alpha channel; save it as RGBA, opaque where it paints and transparent "
        "elsewhere");
  if (s.image.width != s.camera.width || s.image.height != s.camera.height)
    fail("the scribble is {}x{} pixels, the view {}x{}; paint on an image of the view's own size",
         s.image.width, s.image.height, s.camera.width, s.camera.height);
}

void check_stroke(const Stroke& s) {
  if (s.painted_pixels == 0) fail("nothing in the scribble is opaque; paint with alpha above one half");
  if (s.painted_pixels == s.missed_pixels)
    fail("none of the {} painted pixels is on the object as this view sees it; is it the right view?",
         s.painted_pixels);
}

void check_material(const PaintRequest& r) {
  check_change(r.material);
  if (r.routing == Routing::none && (r.color || !r.material.empty()))
    fail_usage("Paint with a material needs to know where; use another --routing.");
}

void check_opacity(const std::vector<Stroke>& strokes) {
  for (const Stroke& s : strokes)
    if (std::any_of(s.coverage.begin(), s.coverage.end(), [](float c) { return c > kMaterialWeight; }))
      return;
  fail(
      "the paint is nowhere more opaque than one half, and a material is painted only from there; paint with "
      "a higher alpha");
}

// Targets of all scribbles together.
struct Paint {
  std::vector<Hit> hits;
  std::vector<Vec3f> targets;   // #hits, linear albedo
  std::vector<uint8_t> inside;  // #hits, 1 in the painted region, 0 just beside it
  float pixel = 1e9f;           // of the finest scribble, on the surface, unit frame
};

float pixel_of(const Stroke& s) { return median(s.footprints) * float(s.scale); }

// later: regions of later strokes, which cover this one.
void add_stroke(const Stroke& s, std::span<const Region> later, Paint& paint) {
  paint.pixel = min(paint.pixel, pixel_of(s));
  for (size_t i = 0; i < s.hits.size(); ++i) {
    const Hit& h = s.hits[i];
    if (std::any_of(later.begin(), later.end(),
                    [&](const Region& r) { return r.weight(h.position, h.normal) >= 0.5f; }))
      continue;
    paint.hits.push_back(h);
    paint.targets.push_back(s.targets[i]);
    paint.inside.push_back(s.coverage[i] >= s.min_alpha);
  }
}

// Replaces the targets by the albedos that give them under the light, after the change of material; returns
// the fraction of targets that no albedo gives.
float solve_for_albedo(const Device& device, const Scene& scene, const SceneLight& light,
                       const MaterialChange& change, Paint& paint) {
  constexpr float kVisible = 0.02f;  // linear radiance
  Appearance appearance = appearance_at(device, scene, paint.hits);
  for (Material& m : appearance.material) m = changed(m, change);
  const std::vector<ShadingTerms<float>> terms = light.terms(paint.hits, appearance);
  size_t outside = 0;
  for (size_t i = 0; i < paint.hits.size(); ++i) {
    const Vec3f target = paint.targets[i], gain = terms[i].gain(), offset = terms[i].specular_offset;
    for (int c = 0; c < 3; ++c)
      paint.targets[i][c] = clamp((target[c] - offset[c]) / max(gain[c], 1e-4f), 0.0f, 1.0f);
    const Vec3f error = terms[i].radiance(paint.targets[i]) - target;
    outside += std::max({abs(error.x), abs(error.y), abs(error.z)}) >= kVisible;
  }
  return float(outside) / float(std::max<size_t>(paint.hits.size(), 1));
}

// Finest cells of half a pixel and a table that holds those on the stroke, so that borders between two colors
// stay as sharp as in the scribble.
FieldConfig branch_config(const Paint& paint) {
  FieldConfig c;
  c.encoding.levels = 8;
  c.encoding.base_resolution = 16;
  c.encoding.finest_resolution = int(clamp(4 / paint.pixel, 64.0f, 4096.0f));
  c.encoding.log2_table = std::clamp(int(std::bit_width(paint.hits.size())), 14, 16);
  c.hidden_layers = 1;
  c.width = 32;
  c.outputs = 3;
  c.output_activation = Activation::sigmoid;
  return c;
}

constexpr int kSteps = 400, kBatch = 2048;

// A batch drawn with replacement, a function of seed and step.
struct Batch {
  std::vector<Vec3f> x, target;

  Batch(const Paint& s, uint64_t seed, int step) : x(kBatch), target(kBatch) {
    for (int i = 0; i < kBatch; ++i) {
      const uint32_t k = Rng(seed, step, i).below(uint32_t(s.hits.size()));
      x[i] = s.hits[k].position;
      target[i] = s.targets[k];
    }
  }
};

// Gradient of the mean cross entropy. Through the sigmoid it becomes out - target, so dark and saturated
// colors, where the sigmoid is flat, are learned as fast as others.
FieldTrainer::Loss cross_entropy(const std::vector<Vec3f>& target) {
  return [&target](int begin, int end, const float* out, float* d_out) {
    for (int i = begin; i < end; ++i)
      for (int c = 0; c < 3; ++c) {
        const int k = 3 * (i - begin) + c;
        d_out[k] = (out[k] - target[i][c]) / (max(out[k] * (1 - out[k]), 1e-6f) * float(kBatch));
      }
  };
}

std::shared_ptr<const Field> fit_branch(const Device& device, const Paint& s, uint64_t seed,
                                        Progress& progress) {
  auto field = std::make_shared<Field>(branch_config(s), seed);
  FieldTrainer trainer(*field, {.encoding_rate = 2e-2f, .network_rate = 1e-2f});
  for (int step = 0; step < kSteps; ++step) {
    check_cancelled(progress, "painting was interrupted; nothing was changed");
    const float fraction = float(step) / kSteps;
    const Batch batch(s, seed, step);
    trainer.step(device, batch.x, cross_entropy(batch.target), 0.5f * (1 + std::cos(kPi * fraction)) + 1e-3f);
    if (step % 40 == 0) progress.report({"paint", 0.2 + 0.8 * fraction, -1, ""});
  }
  return field;
}

// The same color everywhere, exactly.
std::shared_ptr<const Field> uniform_branch(Vec3f color) {
  FieldConfig c;
  c.hidden_layers = 0;
  auto field = std::make_shared<Field>(c, 0);
  for (Param& p : field->params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  Param& bias = field->params().all().back();
  for (int i = 0; i < 3; ++i) bias.value[i] = color[i];
  return field;
}

void measure_branch(const Device& device, const Field& branch, const Paint& s, PaintReport& report) {
  std::vector<Vec3f> x;
  std::vector<size_t> index;
  for (size_t i = 0; i < s.hits.size(); ++i) {
    if (!s.inside[i]) continue;
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

std::vector<Stroke> trace_strokes(const Device& device, const Scene& scene, const PaintRequest& request) {
  if (request.scribbles.empty()) fail("there is no scribble to paint");
  for (const Scribble& s : request.scribbles) check_scribble(s);
  std::vector<Stroke> strokes;
  for (const Scribble& s : request.scribbles) {
    strokes.push_back(trace_stroke(device, scene, s.camera, s.image));
    check_stroke(strokes.back());
  }
  return strokes;
}

// For Routing::none.
std::shared_ptr<const Field> relearn_all(const Device& device, const Scene& scene,
                                         const PaintRequest& request, const Paint& paint,
                                         const std::vector<Region>& regions, Progress& progress) {
  ColorSamples painted;
  for (size_t i = 0; i < paint.hits.size(); ++i) {
    if (!paint.inside[i]) continue;
    painted.positions.push_back(paint.hits[i].position);
    painted.colors.push_back(paint.targets[i]);
  }
  std::vector<Camera> views;
  for (const Scribble& s : request.scribbles) views.push_back(s.camera);
  return relearn(device, scene, painted, beside_strokes(device, scene, views, regions), request.seed,
                 progress);
}

void count(const std::vector<Stroke>& strokes, const std::vector<Region>& regions, PaintReport& report) {
  for (const Stroke& s : strokes) {
    report.painted_pixels += s.painted_pixels;
    report.missed_pixels += s.missed_pixels;
  }
  for (const Region& r : regions) report.points += r.points().positions.size();
}

}  // namespace

PaintResult paint(const Device& device, const Scene& scene, const PaintRequest& request, Progress& progress) {
  PaintResult result;
  PaintReport& report = result.report;
  check_material(request);
  const double start = steady_seconds();
  const std::vector<Stroke> strokes = trace_strokes(device, scene, request);
  if (!request.material.empty()) check_opacity(strokes);
  std::vector<Region> regions;
  for (const Stroke& s : strokes) regions.push_back(stroke_region(s, request.routing));
  count(strokes, regions, report);
  Paint paint;
  for (size_t i = 0; i < strokes.size(); ++i)
    add_stroke(strokes[i], std::span(regions).subspan(i + 1), paint);
  if (request.color) std::fill(paint.targets.begin(), paint.targets.end(), *request.color);
  if (request.seen_in)
    report.out_of_reach = solve_for_albedo(device, scene, *request.seen_in, request.material, paint);
  const double traced = steady_seconds();
  progress.report({"paint", 0.2, -1, ""});
  result.layer.id = request.id;
  result.layer.erase = result.layer.erase_material = request.erase;
  result.layer.unlit = request.unlit;
  result.layer.material = request.material;
  if (request.routing == Routing::none) {
    result.layer.everywhere = true;
    result.layer.albedo = relearn_all(device, scene, request, paint, regions, progress);
  } else {
    if (!request.erase)
      result.layer.albedo =
          request.color ? uniform_branch(*request.color) : fit_branch(device, paint, request.seed, progress);
    result.layer.region = std::move(regions.front());
    result.layer.also.assign(std::make_move_iterator(regions.begin() + 1),
                             std::make_move_iterator(regions.end()));
  }
  if (result.layer.albedo) measure_branch(device, *result.layer.albedo, paint, report);
  report.trace_seconds = traced - start;
  report.train_seconds = steady_seconds() - traced;
  return result;
}

}  // namespace cei3d
