// SPDX-License-Identifier: Apache-2.0
// A lat-long light blurred by the reflection lobes of any roughness, and the lookup of samples in it.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "core/math/lobe_row.h"
#include "core/math/reflection_axis.h"
#include "engine/reconstruct/appearance/lobe_blur.h"
#include "engine/reconstruct/appearance/split_rows.h"
#include "model/light/envmap.h"

namespace cei3d {

// Blurs of a light for a ladder of roughnesses, from which those between are interpolated.
class BlurLadder {
 public:
  explicit BlurLadder(int light_height) : height_(light_height) {}

  static constexpr int kLevels = 10;
  static float roughness(int level);
  struct Place {
    int level = 0;    // interpolate between this level and the next
    float above = 0;  // share of the next level, [0, 1]
  };
  static Place place(float roughness);

  const LobeBlur& level(int i);  // made on first use
  int height() const { return height_; }

 private:
  int height_;
  std::array<std::unique_ptr<LobeBlur>, kLevels> blurs_;
};

// Where a row reads the blurred light for a part of the split sum, given a roughness: a stretched lobe is a
// lobe_row().
struct ReflectedSky {
  static constexpr int kMaxLobes = kRowLobes;
  BlurLadder::Place lobe;  // where the roughness of the round lobes lies on the ladder
  int count = 1;           // number of round lobes
  EnvTaps taps[kMaxLobes];
  float weight[kMaxLobes] = {1};
  float open = 1;  // share of the lobe that meets the sky
};
ReflectedSky reflected_sky(const SplitRow&, ReflectionPart, float roughness, int light_height);

// Blurs of a light by level; empty: level not in use.
using Blurred = std::array<std::vector<Vec3f>, BlurLadder::kLevels>;
Vec3f radiance_at(const Blurred&, const ReflectedSky&);
// The radiance that the lobe of a row collects: that of the sky where it is open, else that of the surface
// which hides the sky.
inline Vec3f incident_at(const Blurred& blurred, const ReflectedSky& at, const SplitRow& row) {
  return radiance_at(blurred, at) + row.far_radiance() * (1 - at.open);
}
// The adjoint of radiance_at(): adds to sum.
void scatter_radiance(const ReflectedSky&, Vec3f radiance, Blurred& sum);

}  // namespace cei3d
