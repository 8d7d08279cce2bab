// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/paint.h"

#include <algorithm>
#include <optional>

#include "core/base/clock.h"
#include "core/base/error.h"
#include "core/math/color.h"
#include "core/math/quantile.h"
#include "engine/edit/albedo_branch.h"
#include "engine/edit/material.h"
#include "engine/edit/relearn.h"
#include "engine/render/scene_light.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

void check_scribble(const Scribble& s) {
  if (s.image.channels != 4)
    fail(
        "The scribble has no alpha channel. Save it as RGBA, opaque where it paints and transparent "
        "elsewhere.");
  if (s.image.width != s.camera.width || s.image.height != s.camera.height)
    fail("The scribble is {}x{} pixels, the view {}x{}. Paint on an image of the view's own size.",
         s.image.width, s.image.height, s.camera.width, s.camera.height);
}

void check_stroke(const Stroke& s) {
  if (s.painted_pixels == 0) fail("Nothing in the scribble is opaque. Paint with alpha above one half.");
  if (s.painted_pixels == s.missed_pixels)
    fail("None of the {} painted pixels is on the object as this view sees it. Is it the right view?",
         s.painted_pixels);
}

void check_material(const PaintRequest& r) {
  if (r.theta > 0 && r.routing != Routing::points)
    fail_usage("Theta is a distance to handler points; it goes with routing by points.");
  check_change(r.material);
  if (r.routing == Routing::none && (r.color || !r.material.empty()))
    fail_usage("Paint with a material needs to know where; use another routing.");
}

void check_opacity(const std::vector<Stroke>& strokes) {
  for (const Stroke& s : strokes)
    if (std::any_of(s.coverage.begin(), s.coverage.end(), [](float c) { return c > kMaterialWeight; }))
      return;
  fail(
      "The paint is nowhere more opaque than one half, and a material is painted only from there. Paint with "
      "a higher alpha.");
}

// Targets of all scribbles together.
struct Paint {
  std::vector<Hit> hits;
  std::vector<Vec3f> targets;   // #hits, linear albedo
  std::vector<uint8_t> inside;  // #hits, 1 in the painted region, 0 just beside it
  std::vector<float> weights;   // #hits, that the color has there
  std::vector<float> opacity;   // #hits, of the pixel that the color is from
  float pixel = 1e9f;           // of the finest scribble, on the surface, unit frame
};

BranchSamples samples_of(const Paint& paint) {
  return {positions_of(paint.hits), paint.targets, paint.pixel};
}

float pixel_of(const Stroke& s) { return median(s.footprints) * float(s.scale); }

// later: regions of later strokes, which cover this one.
void add_stroke(const Stroke& s, std::span<const Region> later, Paint& paint) {
  if (s.hits.empty()) return;
  paint.pixel = min(paint.pixel, pixel_of(s));
  for (size_t i = 0; i < s.hits.size(); ++i) {
    const Hit& h = s.hits[i];
    if (std::any_of(later.begin(), later.end(),
                    [&](const Region& r) { return r.weight(h.position, h.normal) >= 0.5f; }))
      continue;
    paint.hits.push_back(h);
    paint.targets.push_back(s.targets[i]);
    paint.inside.push_back(s.coverage[i] >= s.min_alpha);
    paint.weights.push_back(s.min_alpha < 0.5f ? s.coverage[i] : 1);
    paint.opacity.push_back(s.opacity[i]);
  }
}

// The one color of all targets, as far as 8 bits show; none: there are several. Browsers and many paint
// programs keep colors multiplied by alpha, so that those of nearly transparent pixels are wrong by many
// steps.
std::optional<Vec3f> only_color(const Paint& paint) {
  constexpr float kStep = 1.5f / 255;
  Vec3f sum{0, 0, 0};
  float weight = 0;
  for (size_t i = 0; i < paint.targets.size(); ++i) {
    sum += paint.targets[i] * square(paint.opacity[i]);
    weight += square(paint.opacity[i]);
  }
  const Vec3f mean = sum / weight;
  for (size_t i = 0; i < paint.targets.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float error = abs(srgb_from_linear(paint.targets[i][c]) - srgb_from_linear(mean[c]));
      if (!(error * paint.opacity[i] < kStep)) return std::nullopt;
    }
  return mean;
}

// The color of the paint where it is a field of its own.
std::shared_ptr<const Field> branch_of(const Device& device, const Scene& scene, const Paint& paint,
                                       const PaintRequest& request, Progress& progress) {
  if (request.color) return uniform_branch(*request.color);
  const bool copies = request.branch.start == BranchStart::trained;
  if (!request.learn_one_color && !copies)
    if (const auto color = only_color(paint)) return uniform_branch(*color);
  BranchSamples samples = samples_of(paint);
  samples.trained = scene.albedo.get();
  return fit_branch(device, samples, request.branch, request.seed, progress);
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

// Whether only colors of the albedo are painted, so that paint of the surface's own color changes nothing.
bool paints_albedo(const PaintRequest& r) {
  return !r.erase && !r.unlit && !r.seen_in && !r.color && r.material.empty() && r.routing != Routing::none;
}

std::vector<Stroke> trace_strokes(const Device& device, const Scene& scene, const PaintRequest& request,
                                  PaintReport& report) {
  if (request.scribbles.empty()) fail("There is no scribble to paint.");
  for (const Scribble& s : request.scribbles) check_scribble(s);
  std::vector<Stroke> strokes;
  for (const Scribble& s : request.scribbles) {
    int unchanged = 0;
    const bool compare = paints_albedo(request);
    strokes.push_back(
        trace_stroke(device, scene, s.camera,
                     compare ? without_unchanged(device, scene, s.camera, s.image, unchanged) : s.image));
    report.unchanged_pixels += unchanged;
    if (strokes.back().painted_pixels > 0 || unchanged == 0) check_stroke(strokes.back());
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

std::vector<Region> regions_of(const std::vector<Stroke>& strokes, const Scene& scene,
                               const PaintRequest& request, PaintReport& report) {
  std::vector<Region> regions;
  for (const Stroke& s : strokes) {
    size_t added = 0;
    Region::Points points = refine_and_label(s, scene.handlers.get(), added);
    report.painted_pixels += s.painted_pixels;
    report.missed_pixels += s.missed_pixels;
    report.refined += added;
    report.points += points.edited_count();
    regions.push_back(stroke_region(s, std::move(points), request.routing, request.theta));
  }
  return regions;
}

}  // namespace

PaintResult paint(const Device& device, const Scene& scene, const PaintRequest& request, Progress& progress) {
  PaintResult result;
  PaintReport& report = result.report;
  check_material(request);
  const double start = steady_seconds();
  const std::vector<Stroke> strokes = trace_strokes(device, scene, request, report);
  if (!request.material.empty()) check_opacity(strokes);
  std::vector<Region> regions = regions_of(strokes, scene, request, report);
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
  if (paint.hits.empty()) return result;  // all of it is the surface's own color
  if (request.routing == Routing::none) {
    result.layer.everywhere = true;
    result.layer.albedo = relearn_all(device, scene, request, paint, regions, progress);
  } else {
    if (!request.erase) result.layer.albedo = branch_of(device, scene, paint, request, progress);
    result.layer.region = std::move(regions.front());
    result.layer.also.assign(std::make_move_iterator(regions.begin() + 1),
                             std::make_move_iterator(regions.end()));
  }
  if (result.layer.albedo) measure_branch(device, *result.layer.albedo.use(), paint, report);
  report.trace_seconds = traced - start;
  report.train_seconds = steady_seconds() - traced;
  return result;
}

}  // namespace cei3d
