// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/find_light_frame.h"

#include <algorithm>
#include <array>

#include "core/base/json.h"
#include "core/math/quantile.h"
#include "engine/reconstruct/appearance/find_rings.h"

namespace cei3d {
namespace {

// A light that stands still and leaves less than this, 43 dB, is kept without comparison.
constexpr double kExplained = 5e-5;
// Maximum ratio of the residuals of a turning light and of one that stands still, for a light to be taken for
// turning.
constexpr double kMaxTurningRatio = 0.8;
// The same where materials of the vertices can be searched: below the first without that search, below the
// second by it, which is done up to kMaxDoubtful. One material leaves much that no light explains; and in
// what depends on the angle to the camera alone, a light that moves with it explains errors of any kind.
constexpr double kMaxCertain = 0.6, kMaxRatioOfSeveral = 0.9, kMaxDoubtful = 0.97;
constexpr float kRoughness = 0.3f;
constexpr int kLightHeight = 24;  // a low resolution suffices
constexpr int kHoldOut = 5;       // every n-th view is held out to compare, if there are at least 2n

// Median over views: robust to single views of another brightness.
double median_ratio(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / std::max(b[i], 1e-12));
  return median(std::move(ratios));
}

struct Compared {
  LightMotion motion = LightMotion::world;  // of the smallest ratio
  double ratio = 1;
  std::vector<LightMotion> possible;  // ratios below kMaxDoubtful
};

// Separations of the light under each motion.
class Motions {
 public:
  Motions(const AppearanceInput& input, std::span<const uint16_t> views, std::span<const Camera> cameras,
          Vec3f axis, uint64_t seed, Progress& progress)
      : samples_(input.samples),
        views_(views),
        cameras_(cameras),
        axis_(axis),
        transport_(input.surface),
        progress_(progress) {
    options_.max_hits = options_.search_hits;
    options_.in_patches = true;
    options_.light_height = kLightHeight;
    options_.seed = seed;
    options_.hold_out = cameras.size() >= 2 * kHoldOut ? kHoldOut : 0;
  }

  std::vector<double> residuals(const LightFrame& frame, bool several) const {
    const auto turns = turns_of(frame, cameras_);
    SurfaceSamples samples = samples_;
    samples.turned = {turns.get(), views_};
    return held_out_residuals(transport_, samples, options_, kRoughness, several, progress_);
  }

  // still: residuals of a light that stands still.
  Compared compare(std::span<const LightMotion> motions, const std::vector<double>& still,
                   bool several) const {
    Compared out;
    for (const LightMotion motion : motions) {
      const LightFrame frame = light_frame(motion, cameras_, axis_);
      const double ratio = median_ratio(residuals(frame, several), still);
      progress_.log(Json{
          {"stage", "light motion"},
          {"motion", light_motion_name(motion)},
          {"rings", frame.rings.size()},
          {"several_materials", several},
          {"ratio",
           ratio}}.dump());
      if (ratio < kMaxDoubtful) out.possible.push_back(motion);
      if (ratio < out.ratio) out.ratio = ratio, out.motion = motion;
    }
    return out;
  }

 private:
  const SurfaceSamples& samples_;
  std::span<const uint16_t> views_;
  std::span<const Camera> cameras_;
  Vec3f axis_;
  Transport transport_;
  LinearSplitOptions options_;
  Progress& progress_;
};

}  // namespace

LightFrame light_frame(LightMotion motion, std::span<const Camera> cameras, Vec3f axis) {
  if (motion == LightMotion::world || cameras.empty()) return {};
  LightFrame frame{motion, axis, to_float(cameras.front().world_from_cam)};
  if (motion == LightMotion::turntable) frame.rings = find_rings(cameras);
  return frame;
}

std::shared_ptr<const LightTurns> turns_of(const LightFrame& frame, std::span<const Camera> cameras) {
  if (frame.motion == LightMotion::world) return nullptr;
  std::vector<Mat3f> rotations;
  for (const Camera& c : cameras) rotations.push_back(frame.room_from_object(c.world_from_cam));
  return std::make_shared<const LightTurns>(light_turns(std::move(rotations)));
}

LightFrame find_light_frame(const AppearanceInput& input, std::span<const uint16_t> views,
                            std::span<const Camera> cameras, Vec3f axis, const MotionSearch& search,
                            Progress& progress) {
  const Motions motions(input, views, cameras, axis, search.seed, progress);
  const std::vector<double> still = motions.residuals({}, false);
  if (still.empty() || median(still) < kExplained) return {};
  Compared found = motions.compare(std::array{LightMotion::camera, LightMotion::turntable}, still, false);
  const double max_ratio = search.several_materials ? kMaxCertain : kMaxTurningRatio;
  if (found.ratio < max_ratio) return light_frame(found.motion, cameras, axis);
  if (found.possible.empty() || !search.several_materials) return {};
  // In rings, a turntable is the more exact of two like motions.
  if (!light_frame(found.motion, cameras, axis).rings.empty()) found.possible = {found.motion};
  found = motions.compare(found.possible, motions.residuals({}, true), true);
  return light_frame(found.ratio < kMaxRatioOfSeveral ? found.motion : LightMotion::world, cameras, axis);
}

}  // namespace cei3d
