// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/joint/start_values.h"

#include <cmath>

#include "core/math/fibonacci.h"
#include "core/math/rng.h"
#include "core/math/sg.h"
#include "model/field/sphere_start.h"

namespace cei3d {
namespace {

constexpr int kLobes = 128;
constexpr float kSharpness = 20, kSharpnessSpread = 100;  // of lobes of light: 20 + |100 N(0, 1)|
constexpr float kLeastGloss = 95, kMostGloss = 125;       // sharpness of the material's lobe
enum : uint64_t { kLight = 0x11947, kGloss = 0x61055 };   // keys of random numbers: what they choose

SgMixture gray_light(uint64_t seed) {
  SgMixture light;
  float power = 0;
  for (int k = 0; k < kLobes; ++k) {
    Rng rng(seed ^ kLight, 0, uint64_t(k));
    const float lambda = kSharpness + kSharpnessSpread * std::abs(rng.normal()), mu = std::abs(rng.normal());
    light.lobes.push_back({fibonacci_direction(k, kLobes), lambda, {mu, mu, mu}});
    power += mu * sg_integral(lambda);
  }
  const float factor = 2 * kPi / power;
  return scaled(std::move(light), {factor, factor, factor});
}

// A Gaussian of this sharpness about the normal stands for GGX of this roughness. [Wang et al. 2009]
float roughness_of_gloss(float sharpness) { return std::pow(2 / sharpness, 0.25f); }

}  // namespace

JointObject start_values(const Device& device, const Preset& preset, uint64_t seed) {
  Rng rng(seed ^ kGloss, 0, 0);
  Material material;
  material.roughness = roughness_of_gloss(kLeastGloss + (kMostGloss - kLeastGloss) * rng.uniform());
  JointObject o{Field(preset.geometry.sdf, seed), Field(preset.appearance.albedo, seed + 1), material,
                gray_light(seed)};
  begin_as_sphere(device, o.sdf, preset.start_radius, seed);
  return o;
}

}  // namespace cei3d
