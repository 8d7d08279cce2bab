// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/hidden_sky.h"

#include <cmath>

#include "core/math/reflection.h"

namespace cei3d {
namespace {

constexpr float kDegree = kPi / 180;
// Where the rings end. The directions of the visibility table are 9 degrees apart.
constexpr std::array<float, kSkyRings> kRingEnds{6 * kDegree,  15 * kDegree, 27 * kDegree,
                                                 42 * kDegree, 60 * kDegree, 90 * kDegree};
// Roughness of the lobe whose radiance weights the hidden directions in their mean.
constexpr float kTypicalRoughness = 0.3f;
// Minimum cosine to the normal of directions that count: the surface itself hides those along it.
constexpr float kHorizon = 0.05f;

const HiddenRings& ring_cosines() {
  static const HiddenRings cosines = [] {
    HiddenRings c{};
    for (size_t i = 0; i < kSkyRings; ++i) c[i] = std::cos(kRingEnds[i]);
    return c;
  }();
  return cosines;
}

// Radiance of the lobe in each ring, relative to one another.
HiddenRings ring_density() {
  HiddenRings d = ring_energy(kTypicalRoughness);
  float inner = 1;
  for (size_t i = 0; i < kSkyRings; inner = ring_cosines()[i++]) d[i] /= inner - ring_cosines()[i];
  return d;
}

}  // namespace

HiddenRings ring_energy(float roughness) {
  const ReflectionLobe<float> lobe = reflection_lobe(roughness);
  HiddenRings energy{};
  float within = 0;
  for (size_t i = 0; i < kSkyRings; ++i) {
    float sum = 0;
    for (int j = 0; j < kReflectionLobes; ++j)
      sum += reflection_share(j) * (1 - std::exp(lobe.lambda[j] * (ring_cosines()[i] - 1)));
    energy[i] = sum - within;
    within = sum;
  }
  for (float& e : energy) e /= within;
  return energy;
}

HiddenSky hidden_sky(const Surface& surface, uint32_t vertex, Vec3f normal, Vec3f mirror,
                     bool mirror_hidden) {
  static const HiddenRings density = ring_density();
  const std::vector<Vec3f>& sky = sky_directions();
  HiddenSky out;
  HiddenRings above{};
  for (int i = 0; i < kSkyDirections; ++i) {
    const float cosine = dot(sky[size_t(i)], mirror);
    if (cosine < ring_cosines().back() || dot(sky[size_t(i)], normal) < kHorizon) continue;
    size_t ring = 0;
    while (cosine < ring_cosines()[ring]) ++ring;
    above[ring] += 1;
    if (surface.sees(vertex, i)) continue;
    out.rings[ring] += 1;
    out.towards += sky[size_t(i)] * density[ring];
  }
  for (size_t i = 0; i < kSkyRings; ++i) out.rings[i] /= max(above[i], 1.0f);
  out.rings[0] = mirror_hidden ? 1.0f : 0.0f;
  if (mirror_hidden) out.towards = mirror;
  if (dot(out.towards, out.towards) > 0) out.towards = normalize(out.towards);
  return out;
}

}  // namespace cei3d
