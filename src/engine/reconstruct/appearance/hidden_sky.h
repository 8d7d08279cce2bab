// SPDX-License-Identifier: Apache-2.0
// How much of the sky around a mirror direction the surface hides: reflection lobes are wider than a ray.
#pragma once

#include <array>

#include "model/geometry/shape/surface.h"

namespace cei3d {

// Rings about the mirror direction; the first is a disk, which the mirror ray represents.
inline constexpr int kSkyRings = 6;
// Share of the sky directions of a ring that the surface hides, of those above the horizon; [0, 1].
using HiddenRings = std::array<float, kSkyRings>;

struct HiddenSky {
  HiddenRings rings{};
  Vec3f towards{0, 0, 0};  // unit, the middle of what is hidden; 0 where nothing is
};
// From the visibility table at a vertex. normal, mirror: unit. mirror_hidden: whether the mirror ray meets
// the surface.
HiddenSky hidden_sky(const Surface&, uint32_t vertex, Vec3f normal, Vec3f mirror, bool mirror_hidden);

// Share of the energy of the round lobe of a roughness about the mirror direction within each ring.
HiddenRings ring_energy(float roughness);
inline float hidden_share(const HiddenRings& hidden, const HiddenRings& energy) {
  float sum = 0;
  for (size_t i = 0; i < kSkyRings; ++i) sum += hidden[i] * energy[i];
  return sum;
}

}  // namespace cei3d
