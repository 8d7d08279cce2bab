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
constexpr float kSharpness = 20, kSharpnessSpread = 100;  // a lobe of light has sharpness 20 + |100 N(0, 1)|
constexpr float kMinSpecular = 0.18f, kMaxSpecular = 0.26f;
constexpr float kMetalness = 0.05f;                      // not stated; 0 would stay
constexpr float kMinGloss = 95, kMaxGloss = 125;         // sharpness of the material's lobe
enum : uint64_t { kLight = 0x11947, kGloss = 0x61055 };  // keys of random numbers: what they choose

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

SgMaterial random_gloss(uint64_t seed) {
  Rng rng(seed ^ kGloss, 0, 0);
  const float sharpness = kMinGloss + (kMaxGloss - kMinGloss) * rng.uniform(), peak = sharpness / (2 * kPi),
              specular = kMinSpecular + (kMaxSpecular - kMinSpecular) * rng.uniform();
  return {sharpness, {peak, peak, peak}, roughness_of_sharpness(sharpness), specular, kMetalness};
}

}  // namespace

JointObject start_values(const Device& device, const Preset& preset, uint64_t seed) {
  const SgMaterial gloss = random_gloss(seed);
  Material material;  // of a dielectric, whose specular albedo is not that of the paper's
  material.roughness = roughness_of_sharpness(gloss.sharpness);
  JointObject o{Field(preset.geometry.sdf, seed), Field(preset.appearance.albedo, seed + 1), material,
                gray_light(seed), gloss};
  begin_as_sphere(device, o.sdf, preset.start_radius, seed);
  return o;
}

}  // namespace cei3d
