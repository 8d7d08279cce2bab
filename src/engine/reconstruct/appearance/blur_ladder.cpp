// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/blur_ladder.h"

#include <algorithm>
#include <cmath>

#include "core/math/ladder.h"
#include "model/light/envmap.h"

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

void add_taps(Vec3f direction, float weight, int height, ReflectedSky& sky) {
  const EnvTaps taps = quick_env_taps(direction, 2 * height, height);
  for (size_t k = 0; k < 4; ++k) {
    sky.pixel[size_t(sky.count) + k] = uint16_t(taps.pixel[k]);
    sky.weight[size_t(sky.count) + k] = weight * taps.weight[k];
  }
  sky.count += 4;
}

ReflectedSky round_sky(const ReflectionAxis<float>& lobe, int height) {
  ReflectedSky sky;
  sky.lobe = BlurLadder::place(lobe.roughness);
  add_taps(lobe.axis, 1, height, sky);
  return sky;
}

// The middle lobe comes first: its taps stand for all of them where one lobe suffices.
ReflectedSky stretched_sky(const LobeFrame<float>& lobe, int height) {
  const LobeRow row = lobe_row(lobe.roughness, lobe.stretch);
  const Vec3f along = normalize(cross(lobe.across, lobe.axis));
  const float cosine = std::cos(row.angle), sine = std::sin(row.angle);
  ReflectedSky sky;
  sky.lobe = BlurLadder::place(row.roughness);
  add_taps(lobe.axis, kRowShares[kRowLobes / 2], height, sky);
  for (const float side : {-1.0f, 1.0f}) {
    Vec2f turned{cosine, side * sine};
    for (int i = 1; i <= kRowLobes / 2; ++i) {
      add_taps(lobe.axis * turned.x + along * turned.y, kRowShares[kRowLobes / 2 + i], height, sky);
      turned = {turned.x * cosine - turned.y * side * sine, turned.y * cosine + turned.x * side * sine};
    }
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

void Blurred::set(int level, const std::vector<Vec3f>& light, BlurLadder& blurs) {
  auto& out = levels_[size_t(level)];
  std::vector<Vec3f> colors;
  blurs.level(level).apply(light, colors);
  out.resize(colors.size());
  for (size_t i = 0; i < colors.size(); ++i) out[i] = PaddedColor{colors[i].x, colors[i].y, colors[i].z, 0};
}

void Blurred::add_to(int level, std::vector<Vec3f>& sum) const {
  const auto& of = levels_[size_t(level)];
  for (size_t i = 0; i < of.size(); ++i) sum[i] += Vec3f{of[i][0], of[i][1], of[i][2]};
}

Vec3f radiance_at(const Blurred& blurred, const ReflectedSky& at) {
  const PaddedColor *below = blurred.of(at.lobe.level), *above = blurred.of(at.lobe.level + 1);
  PaddedColor below_sum{}, above_sum{};
  for (size_t k = 0; k < size_t(at.count); ++k) {
    below_sum += below[at.pixel[k]] * at.weight[k];
    above_sum += above[at.pixel[k]] * at.weight[k];
  }
  const PaddedColor sum = below_sum * (at.open * (1 - at.lobe.above)) + above_sum * (at.open * at.lobe.above);
  return {sum[0], sum[1], sum[2]};
}

void scatter_radiance(const ReflectedSky& at, Vec3f radiance, Blurred& sum) {
  PaddedColor *below = sum.of(at.lobe.level), *above = sum.of(at.lobe.level + 1);
  const PaddedColor color{radiance.x, radiance.y, radiance.z, 0};
  const PaddedColor to_below = color * (at.open * (1 - at.lobe.above)),
                    to_above = color * (at.open * at.lobe.above);
  for (size_t k = 0; k < size_t(at.count); ++k) {
    below[at.pixel[k]] += to_below * at.weight[k];
    above[at.pixel[k]] += to_above * at.weight[k];
  }
}

}  // namespace cei3d
