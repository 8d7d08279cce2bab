// SPDX-License-Identifier: Apache-2.0
// A lat-long light blurred by the reflection lobes of any roughness, and the lookup of samples in it.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/math/lobe_row.h"
#include "core/math/reflection_axis.h"
#include "engine/reconstruct/appearance/lobe_blur.h"
#include "engine/reconstruct/appearance/split_rows.h"

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
// lobe_row(), each of whose lobes has four taps.
struct ReflectedSky {
  static constexpr int kMaxTaps = 4 * kRowLobes;
  BlurLadder::Place lobe;                // where the roughness of the round lobes lies on the ladder
  int count = 0;                         // number of taps
  std::array<uint16_t, kMaxTaps> pixel;  // of a light of at most 181 rows
  std::array<float, kMaxTaps> weight;    // their sum is 1
  float open = 1;                        // share of the lobe that meets the sky
};
ReflectedSky reflected_sky(const SplitRow&, ReflectionPart, float roughness, int light_height);

// Linear red, green and blue, and a fourth that is not used, as processors read and add them at once.
typedef float PaddedColor __attribute__((vector_size(16)));

// Blurs of a light by level; empty: level not in use.
class Blurred {
 public:
  // All of 0.
  void clear(int level, size_t cells) { levels_[size_t(level)].assign(cells, PaddedColor{}); }
  void set(int level, const std::vector<Vec3f>& light, BlurLadder&);
  void add_to(int level, std::vector<Vec3f>& sum) const;
  PaddedColor* of(int level) { return levels_[size_t(level)].data(); }
  const PaddedColor* of(int level) const { return levels_[size_t(level)].data(); }

 private:
  std::array<std::vector<PaddedColor>, BlurLadder::kLevels> levels_;
};
Vec3f radiance_at(const Blurred&, const ReflectedSky&);
// The radiance that the lobe of a row collects: that of the sky where it is open, else that of the surface
// which hides the sky.
inline Vec3f incident_at(const Blurred& blurred, const ReflectedSky& at, const SplitRow& row) {
  return radiance_at(blurred, at) + row.far_radiance() * (1 - at.open);
}
// The adjoint of radiance_at(): adds to sum.
void scatter_radiance(const ReflectedSky&, Vec3f radiance, Blurred& sum);

}  // namespace cei3d
