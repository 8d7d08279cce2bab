// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/joint/sg_material.h"

#include <cmath>

#include "core/math/brdf.h"

namespace cei3d {
namespace {

constexpr float kTwoPi = 2 * kPi;

}  // namespace

float roughness_of_sharpness(float sharpness) {
  return clamp(std::pow(2 / sharpness, 0.25f), kMinRoughness, 1.0f);
}

SgMaterial sg_material_of(const Material& m) {
  const float rho = max(m.roughness, kMinRoughness), sharpness = 2 / (rho * rho * rho * rho),
              peak = sharpness / kTwoPi;
  return {sharpness, {peak, peak, peak}, rho, kDielectricF0 * m.specular, m.metalness};
}

Material nearest_material(const SgMaterial& m) {
  const float mean = (m.amplitude.x + m.amplitude.y + m.amplitude.z) / 3,
              reflectance = m.specular * mean * kTwoPi / m.sharpness;
  return {roughness_of_sharpness(m.sharpness),
          clamp(reflectance / (kDielectricF0 * max(1 - m.metalness, 1e-3f)), 0.0f, 1.0f), m.metalness};
}

}  // namespace cei3d
