// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/start/start.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/base/cancel.h"
#include "core/base/json.h"
#include "core/image/area.h"
#include "engine/reconstruct/poses/align_views.h"

namespace cei3d {

namespace {

// Fraction of the schedule during which colors do not depend on the view after a start carved by colors:
// otherwise mirror images would hollow the shape out further. Not after stereo, whose shape is close enough
// to the surface: there highlights would dent it if colors could not depend on the view.
constexpr float kMatteUntil = 0.25f;
// dB by which another start must be better than the visual hull, which is robust. Where the hull is wrong the
// difference is at least 1.1 dB; equally good starts differ by up to .4 dB.
constexpr double kMinGain = 0.8;
// Minimum number of views that must have a cell in their frame for the start shape to fill it. With fewer
// views, floating blobs in front of the surface remain.
constexpr int kMinViews = 3;
constexpr int kCompareSide = 160;  // maximum side of the images used to align cameras, pixels
constexpr int kMaxAlignments = 5;  // maximum number of alignments of the cameras
// Minimum distance by which an alignment has to move the object in the images to be used, pixels, median over
// views.
constexpr double kMinAlignment = 0.5;
constexpr double kMinAlignmentGain = 0.3;  // minimum gain of the first alignment, dB
// Minimum share of the noted exposures that has to be found in the photographs. It is below 1 because colors
// that depend on the view explain a part of them, and about 0 where the notes do not apply to the
// photographs.
constexpr double kMinShareFound = 0.15;

// Cells that the object may fill. Masks are grown by half a cell, as the cameras see it at the object's
// center, or rods thinner than a cell would be lost: training removes excess volume, but does not add volume
// in empty space.
VisualHull hull_of(const PixelStore& pixels, int cells) {
  std::vector<Area> areas;
  areas.reserve(pixels.cameras().size());
  std::vector<HullMask> masks;
  for (size_t v = 0; v < pixels.cameras().size(); ++v) {
    const Camera& c = pixels.cameras()[v];
    const int half_cell = int(std::lround(c.fx / length(c.center) / cells));
    areas.push_back(dilated(pixels.masks()[v], c.width, c.height, half_cell));
    masks.push_back({c, areas.back()});
  }
  const int min_views = std::min(kMinViews, int(masks.size() + 1) / 2);
  return visual_hull(masks, cells, {-1, -1, -1}, {1, 1, 1}, 0, min_views);
}

StartShape shape_of(const VisualHull& hull, bool anchored, float matte_until) {
  return {{hull.n, signed_distance(hull)}, anchored, matte_until};
}

// By least squares over views and channels, of logarithms.
double share_found(std::span<const Vec3f> noted, std::span<const Vec3f> found) {
  double both = 0, squares = 0;
  for (size_t v = 0; v < noted.size(); ++v)
    for (int c = 0; c < 3; ++c) {
      const double n = std::log(double(noted[v][c]));
      both += n * std::log(double(found[v][c]));
      squares += n * n;
    }
  return squares > 0 ? both / squares : 0;
}

// A field after a short training, and its PSNR in dB on random training pixels.
struct Trial {
  StartShape shape;
  std::unique_ptr<GeometryStage> trained;
  double psnr = -1e9;
};

std::vector<Start> starts_to_try(const TrialOptions& options) {
  if (options.hull_alone) return {Start::hull};
  // Carving takes the colors of a point for the same in all views.
  if (options.light.motion != LightMotion::world) return {Start::hull, Start::stereo};
  return {Start::hull, Start::carved, Start::stereo};
}

const char* name_of(Start start) {
  return start == Start::hull ? "hull" : start == Start::carved ? "carved" : "stereo";
}

// done: fraction of all trials before this one.
Trial tried(const Device& device, const PixelStore& pixels, const TrialOptions& options, Start start,
            uint64_t seed, double done, Progress& progress) {
  Trial trial{start_shape(pixels, start, seed, options.shapes, progress),
              std::make_unique<GeometryStage>(device, pixels, options.geometry, seed)};
  GeometryStage& stage = *trial.trained;
  stage.set_light(options.light);
  stage.prefit(trial.shape, progress);
  const double trials = double(starts_to_try(options).size()), begin = options.clock();
  for (int step = 0; step < options.steps; ++step) {
    check_cancelled(progress);
    const double u = double(step) / options.steps;
    stage.step(step, u, {}, progress);
    if (step % 20 == 0) progress.report({"choosing a start", done + u / trials, -1, ""});
  }
  trial.psnr = stage.evaluate(pixels, options.rays, 1).psnr();
  progress.log(Json{
      {"stage", "trial"}, {"start", name_of(start)}, {"psnr", trial.psnr}, {"took", options.clock() - begin}}
                   .dump());
  return trial;
}

// Aligns the cameras with what was trained from the visual hull, and tries the hull again, while that moves
// the object's image or changes the focal length, and explains more of the pixels. Returns the last trial of
// the hull.
Trial align_with_hull(const Device& device, PixelStore& pixels, const TrialOptions& options, Trial hull,
                      uint64_t seed, Progress& progress) {
  FocalPrior prior{options.focal_error};
  const double begin = options.clock();
  for (int round = 0; round < kMaxAlignments; ++round) {
    if (options.align_seconds > 0 && options.clock() - begin > options.align_seconds) break;
    AlignedViews aligned =
        align_views(show_views(*hull.trained, pixels, kCompareSide, progress), pixels, prior);
    const double focal = prior.found * aligned.focal;
    Json log{{"stage", "alignment"}, {"pixels", aligned.pixels}, {"focal", focal}, {"psnr", hull.psnr}};
    if (aligned.pixels < kMinAlignment && aligned.focal == 1) {
      progress.log(log.dump());
      break;
    }
    std::vector<Camera> before = pixels.cameras();
    pixels.set_cameras(std::move(aligned.cameras));
    Trial again = tried(device, pixels, options, Start::hull, seed, 0, progress);
    log["aligned_psnr"] = again.psnr;
    progress.log(log.dump());
    if (again.psnr < hull.psnr + (round == 0 ? kMinAlignmentGain : 0)) {
      pixels.set_cameras(std::move(before));
      break;
    }
    hull = std::move(again);
    prior.found = focal;
  }
  return hull;
}

// Takes over the exposures that the cameras noted, and tries the visual hull again, where the photographs are
// as much brighter or darker than what was trained.
Trial expose_with_hull(const Device& device, PixelStore& pixels, const TrialOptions& options, Trial hull,
                       uint64_t seed, Progress& progress) {
  const ShownViews views = show_views(*hull.trained, pixels, kCompareSide, progress);
  const double share = share_found(options.exposures, find_exposures(views, pixels));
  progress.log(Json{{"stage", "noted exposures"}, {"share_found", share}}.dump());
  if (share < kMinShareFound) return hull;
  pixels.set_exposures(options.exposures);
  return tried(device, pixels, options, Start::hull, seed, 0, progress);
}

}  // namespace

StartShape start_shape(const PixelStore& pixels, Start start, uint64_t seed, const ShapeOptions& options,
                       const Progress& progress) {
  if (start == Start::stereo) {
    const VisualHull hull = hull_of(pixels, options.stereo_cells);
    return shape_of(carve_by_depths(hull, stereo_depths(pixels, hull, options.stereo, progress)), true, 0);
  }
  const VisualHull hull = hull_of(pixels, options.cells);
  if (start == Start::hull) return shape_of(hull, false, 0);
  CarveOptions carving = options.carving;
  carving.seed = seed;
  return shape_of(carve(pixels, hull, carving, progress), true, kMatteUntil);
}

StartShape choose_start(const Device& device, PixelStore& pixels, const TrialOptions& options, uint64_t seed,
                        Progress& progress) {
  StartShape best;
  double best_psnr = -1e9;
  Start chosen = Start::hull;
  const std::vector<Start> starts = starts_to_try(options);
  for (size_t i = 0; i < starts.size(); ++i) {
    const Start start = starts[i];
    check_cancelled(progress);
    const double done = double(i) / double(starts.size());
    Trial trial = tried(device, pixels, options, start, seed, done, progress);
    if (start == Start::hull && !options.exposures.empty())
      trial = expose_with_hull(device, pixels, options, std::move(trial), seed, progress);
    if (start == Start::hull && options.align)
      trial = align_with_hull(device, pixels, options, std::move(trial), seed, progress);
    if (trial.psnr <= best_psnr) continue;
    chosen = start;
    best = std::move(trial.shape);
    best_psnr = trial.psnr + (start == Start::hull ? kMinGain : 0);
  }
  progress.log(Json{{"stage", "start"}, {"chosen", name_of(chosen)}}.dump());
  return best;
}

}  // namespace cei3d
