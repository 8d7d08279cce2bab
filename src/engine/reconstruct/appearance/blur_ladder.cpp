// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/blur_ladder.h"

#include <algorithm>
#include <cmath>

namespace cei3d {
namespace {

constexpr float kSmoothest = 0.1f, kRoughest = 0.95f;  // of the ladder

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

ReflectedSky reflected_sky(const SplitRow& row, ReflectionPart part, float roughness, int light_height) {
  const ReflectionAxis<float> lobe =
      reflection_axis(reflection_axis_table(part), row.normal, row.to_camera, roughness);
  return {BlurLadder::place(lobe.roughness), env_taps(lobe.axis, 2 * light_height, light_height)};
}

Vec3f radiance_at(const Blurred& blurred, const ReflectedSky& at) {
  const auto &below = blurred[size_t(at.lobe.level)], &above = blurred[size_t(at.lobe.level) + 1];
  Vec3f sum{0, 0, 0};
  for (int k = 0; k < 4; ++k) {
    const int pixel = at.taps.pixel[k];
    sum += (below[pixel] * (1 - at.lobe.above) + above[pixel] * at.lobe.above) * at.taps.weight[k];
  }
  return sum;
}

void scatter_radiance(const ReflectedSky& at, Vec3f radiance, Blurred& sum) {
  auto &below = sum[size_t(at.lobe.level)], &above = sum[size_t(at.lobe.level) + 1];
  for (int k = 0; k < 4; ++k) {
    const Vec3f part = radiance * at.taps.weight[k];
    below[at.taps.pixel[k]] += part * (1 - at.lobe.above);
    above[at.taps.pixel[k]] += part * at.lobe.above;
  }
}

}  // namespace cei3d
