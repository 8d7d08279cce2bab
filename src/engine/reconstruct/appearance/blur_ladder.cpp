// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/blur_ladder.h"

#include <algorithm>
#include <cmath>

#include "core/math/ladder.h"

namespace cei3d {
namespace {

constexpr GeometricLadder kRoughnesses{0.1f, 0.95f};
constexpr float kRound = 1.15f;  // maximum stretch of a lobe that is taken to be round

}  // namespace

float BlurLadder::roughness(int level) { return kRoughnesses.at(float(level) / (kLevels - 1)); }

BlurLadder::Place BlurLadder::place(float roughness) {
  const float at = kRoughnesses.place(roughness) * (kLevels - 1);
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

ReflectedSky stretched_sky(const LobeFrame<float>& lobe, int height) {
  const LobeRow row = lobe_row(lobe.roughness, lobe.stretch);
  const Vec3f along = normalize(cross(lobe.across, lobe.axis));
  ReflectedSky sky;
  sky.lobe = BlurLadder::place(row.roughness);
  sky.count = kRowLobes;
  for (int i = 0; i < kRowLobes; ++i) {
    const float angle = row.angle * float(i - kRowLobes / 2);
    sky.taps[i] = env_taps(lobe.axis * std::cos(angle) + along * std::sin(angle), 2 * height, height);
    sky.weight[i] = kRowShares[i];
  }
  return sky;
}

HiddenRings energy_at(BlurLadder::Place at) {
  static const auto ladder = [] {
    std::array<HiddenRings, BlurLadder::kLevels> energy;
    for (int i = 0; i < BlurLadder::kLevels; ++i) energy[size_t(i)] = ring_energy(BlurLadder::roughness(i));
    return energy;
  }();
  HiddenRings mix;
  const HiddenRings &below = ladder[size_t(at.level)], &above = ladder[size_t(at.level) + 1];
  for (size_t i = 0; i < kSkyRings; ++i) mix[i] = below[i] * (1 - at.above) + above[i] * at.above;
  return mix;
}

}  // namespace

ReflectedSky reflected_sky(const SplitRow& row, ReflectionPart part, float roughness, int light_height) {
  const PartTables tables{reflection_axis_table(part), reflection_stretch_table(part)};
  const ReflectionAxis<float> round = reflection_axis(tables.axis, row.normal, row.to_camera, roughness);
  const LobeFrame<float> lobe = lobe_frame(tables, row.normal, row.to_camera, roughness);
  ReflectedSky sky =
      lobe.stretch > kRound ? stretched_sky(lobe, light_height) : round_sky(round, light_height);
  sky.open = 1 - hidden_share(row.hidden, energy_at(BlurLadder::place(round.roughness)));
  return sky;
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
  return sum * at.open;
}

void scatter_radiance(const ReflectedSky& at, Vec3f radiance, Blurred& sum) {
  auto &below = sum[size_t(at.lobe.level)], &above = sum[size_t(at.lobe.level) + 1];
  for (int l = 0; l < at.count; ++l)
    for (int k = 0; k < 4; ++k) {
      const Vec3f part = radiance * (at.open * at.weight[l] * at.taps[l].weight[k]);
      below[at.taps[l].pixel[k]] += part * (1 - at.lobe.above);
      above[at.taps[l].pixel[k]] += part * at.lobe.above;
    }
}

}  // namespace cei3d
