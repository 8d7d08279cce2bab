// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/find_light_frame.h"

#include <algorithm>

#include "core/base/json.h"
#include "core/math/quantile.h"

namespace cei3d {
namespace {

// Maximum ratio of the residuals of a turning light and of one that stands still, for a light to be taken for
// turning. A light that stands still and leaves less than kExplained, 43 dB, is kept without comparison.
constexpr double kMaxTurningRatio = 0.8, kExplained = 5e-5;
// The same where only the light that stands still fades: reflections that move otherwise average out.
constexpr double kMaxRatioOfFaded = 0.95;
constexpr float kRoughness = 0.3f;
constexpr int kLightHeight = 24;  // a low resolution suffices
constexpr int kHoldOut = 5;       // every n-th view is held out to compare, if there are at least 2n

// Median over views: robust to single views of another brightness.
double median_ratio(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / std::max(b[i], 1e-12));
  return median(std::move(ratios));
}

}  // namespace

LightFrame light_frame(LightMotion motion, std::span<const Camera> cameras, Vec3f axis) {
  if (motion == LightMotion::world || cameras.empty()) return {};
  return {motion, axis, to_float(cameras.front().world_from_cam)};
}

std::shared_ptr<const LightTurns> turns_of(const LightFrame& frame, std::span<const Camera> cameras) {
  if (frame.motion == LightMotion::world) return nullptr;
  std::vector<Mat3f> rotations;
  for (const Camera& c : cameras) rotations.push_back(frame.room_from_object(c.world_from_cam));
  return std::make_shared<const LightTurns>(light_turns(std::move(rotations)));
}

LightFrame find_light_frame(const AppearanceInput& input, std::span<const uint16_t> views,
                            std::span<const Camera> cameras, Vec3f axis, uint64_t seed, Progress& progress) {
  LinearSplitOptions options;
  options.max_hits = options.search_hits;
  options.light_height = kLightHeight;
  options.seed = seed;
  options.hold_out = cameras.size() >= 2 * kHoldOut ? kHoldOut : 0;
  const Transport transport(input.surface);
  const auto fit = [&](LightMotion motion) {
    const auto turns = turns_of(light_frame(motion, cameras, axis), cameras);
    SurfaceSamples samples = input.samples;
    samples.turned = {turns.get(), views};
    return fit_dielectric(transport, samples, options, kRoughness, progress);
  };
  const DielectricFit still = fit(LightMotion::world);
  if (still.residuals.empty() || median(still.residuals) < kExplained) return {};
  double smallest = 1;
  LightMotion best = LightMotion::world;
  for (const LightMotion motion : {LightMotion::camera, LightMotion::turntable}) {
    const DielectricFit turning = fit(motion);
    const double ratio = median_ratio(turning.residuals, still.residuals);
    progress.log(Json{{"stage", "light motion"},
                      {"motion", light_motion_name(motion)},
                      {"ratio", ratio},
                      {"faded", {{"still", still.faded}, {"turning", turning.faded}}}}
                     .dump());
    const bool stronger = still.faded && !turning.faded;
    if (ratio >= std::min(smallest, stronger ? kMaxRatioOfFaded : kMaxTurningRatio)) continue;
    smallest = ratio;
    best = motion;
  }
  return light_frame(best, cameras, axis);
}

}  // namespace cei3d
