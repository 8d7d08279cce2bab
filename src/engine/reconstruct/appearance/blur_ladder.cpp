// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/blur_ladder.h"

#include <algorithm>
#include <cmath>

#include "core/math/reflection.h"

namespace cei3d {
namespace {

constexpr float kSmoothest = 0.1f, kRoughest = 0.95f;  // of the ladder
constexpr float kRound = 1.15f;                        // maximum stretch of a lobe that is taken to be round

}  // namespace

float BlurLadder::roughness(int level) {
  return kSmoothest * std::pow(kRoughest / kSmoothest, float(level) / (kLevels - 1));
}

BlurLadder::Place BlurLadder::place(float roughness) {
  const float at =
      clamp(std::log(roughness / kSmoothest) / std::log(kRoughest / kSmoothest), 0.0f, 1.0f) * (kLevels - 1);
  const int level = std::min(int(at), kLevels - 2);
  return {level, at - float(level)};
}

const LobeBlur& BlurLadder::level(int i) {
  auto& blur = blurs_[size_t(i)];
  if (!blur) blur = std::make_unique<LobeBlur>(roughness(i), height_);
  return *blur;
}

namespace {

ReflectedSky round_sky(const ReflectionAxis<float>& lobe, int height) {
  ReflectedSky sky;
  sky.lobe = BlurLadder::place(lobe.roughness);
  sky.taps[0] = env_taps(lobe.axis, 2 * height, height);
  return sky;
}

// Three round lobes as wide as the stretched one is across the plane of incidence; the variance of their
// angles is what its peak has more along that plane. (That of the whole lobe, three times as large because of
// its tails, would move the outer lobes out of the peak.) The variance of a lobe grows with roughness^4.
ReflectedSky stretched_sky(const LobeFrame<float>& lobe, int height) {
  constexpr float kMaxAngle = 1.2f, kOuter = 1.0f / 6;  // Gauss-Hermite: at +- sqrt(3) standard deviations
  const float variance = reflection_peak_width(lobe.roughness) * (lobe.stretch - 1 / lobe.stretch),
              angle = min(std::sqrt(3 * variance), kMaxAngle);
  const Vec3f along = normalize(cross(lobe.across, lobe.axis)) * std::sin(angle);
  ReflectedSky sky = round_sky({lobe.axis, lobe.roughness / std::sqrt(std::sqrt(lobe.stretch))}, height);
  sky.count = 3;
  sky.weight[0] = 1 - 2 * kOuter;
  for (const int side : {1, 2}) {
    const Vec3f axis = lobe.axis * std::cos(angle) + (side == 1 ? along : along * -1.0f);
    sky.taps[side] = env_taps(axis, 2 * height, height);
    sky.weight[side] = kOuter;
  }
  return sky;
}

}  // namespace

ReflectedSky reflected_sky(const SplitRow& row, ReflectionPart part, float roughness, int light_height) {
  const PartTables tables{reflection_axis_table(part), reflection_stretch_table(part)};
  const LobeFrame<float> lobe = lobe_frame(tables, row.normal, row.to_camera, roughness);
  if (lobe.stretch > kRound) return stretched_sky(lobe, light_height);
  return round_sky(reflection_axis(tables.axis, row.normal, row.to_camera, roughness), light_height);
}

Vec3f radiance_at(const Blurred& blurred, const ReflectedSky& at) {
  const auto &below = blurred[size_t(at.lobe.level)], &above = blurred[size_t(at.lobe.level) + 1];
  Vec3f sum{0, 0, 0};
  for (int l = 0; l < at.count; ++l)
    for (int k = 0; k < 4; ++k) {
      const int pixel = at.taps[l].pixel[k];
      sum += (below[pixel] * (1 - at.lobe.above) + above[pixel] * at.lobe.above) *
             (at.weight[l] * at.taps[l].weight[k]);
    }
  return sum;
}

void scatter_radiance(const ReflectedSky& at, Vec3f radiance, Blurred& sum) {
  auto &below = sum[size_t(at.lobe.level)], &above = sum[size_t(at.lobe.level) + 1];
  for (int l = 0; l < at.count; ++l)
    for (int k = 0; k < 4; ++k) {
      const Vec3f part = radiance * (at.weight[l] * at.taps[l].weight[k]);
      below[at.taps[l].pixel[k]] += part * (1 - at.lobe.above);
      above[at.taps[l].pixel[k]] += part * at.lobe.above;
    }
}

}  // namespace cei3d
