// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/start/start.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/image/area.h"
#include "engine/reconstruct/start/carve.h"
#include "engine/reconstruct/start/stereo.h"

namespace cei3d {

namespace {

constexpr int kCells = 128, kStereoCells = 192;  // an axis
// Carved by colours, mirror images go on eating at the shape unless they have to be the surface. Stereo's is
// near enough the surface for highlights to be told from it; without a view to depend on they would dent it.
constexpr float kMatteUntil = 0.25f;
// dB by which another start has to beat the visual hull, which nothing deceives: where the hull is wrong they
// differ by one and a half and more.
constexpr double kClearly = 0.3;
// Views that must have a place in their frame before matter may start there. With fewer it can hang anywhere
// along their rays and look right to them: a blob before the real surface, to everybody else.
constexpr int kLeastViews = 3;

// Cells that may hold matter: masks are grown by half a cell, as the cameras see it at the object's centre,
// or rods thinner than a cell would be lost, and descent makes no matter where there is none. It does take
// away.
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
  const int least_views = std::min(kLeastViews, int(masks.size() + 1) / 2);
  return visual_hull(masks, cells, {-1, -1, -1}, {1, 1, 1}, 0, least_views);
}

StartShape shape_of(const VisualHull& hull, bool anchored, float matte_until) {
  return {{hull.n, signed_distance(hull)}, anchored, matte_until};
}

// dB on random training pixels after a short training.
double trial(const Device& device, const PixelStore& pixels, const GeometryOptions& options,
             const StartShape& shape, uint64_t seed, Progress& progress) {
  constexpr int kSteps = 400, kRays = 32768;
  GeometryStage stage(device, pixels, options, seed);
  stage.prefit(shape);
  for (int step = 0; step < kSteps; ++step) {
    if (progress.cancelled())
      throw Error(ErrorCode::interrupted, "interrupted before there was a state to save");
    stage.step(step, double(step) / kSteps);
    if (step % 20 == 0) progress.report({"choosing a start", 0.01, -1, ""});
  }
  return stage.evaluate(pixels, kRays, 1).psnr();
}

}  // namespace

StartShape start_shape(const PixelStore& pixels, Start start, uint64_t seed) {
  if (start == Start::stereo) {
    const VisualHull hull = hull_of(pixels, kStereoCells);
    return shape_of(carve_by_depths(hull, stereo_depths(pixels, hull, {})), true, 0);
  }
  const VisualHull hull = hull_of(pixels, kCells);
  if (start == Start::hull) return shape_of(hull, false, 0);
  CarveOptions carving;
  carving.seed = seed;
  return shape_of(carve(pixels, hull, carving), true, kMatteUntil);
}

StartShape choose_start(const Device& device, const PixelStore& pixels, const GeometryOptions& options,
                        uint64_t seed, Progress& progress) {
  StartShape best;
  double best_psnr = -1e9;
  Json log{{"stage", "start"}};
  const std::pair<Start, const char*> starts[] = {
      {Start::hull, "hull_psnr"}, {Start::carved, "carved_psnr"}, {Start::stereo, "stereo_psnr"}};
  for (const auto& [start, name] : starts) {
    StartShape shape = start_shape(pixels, start, seed);
    const double psnr = trial(device, pixels, options, shape, seed, progress);
    log[name] = psnr;
    if (psnr <= best_psnr) continue;
    best = std::move(shape);
    best_psnr = psnr + (start == Start::hull ? kClearly : 0);
  }
  progress.log(log.dump());
  return best;
}

}  // namespace cei3d
