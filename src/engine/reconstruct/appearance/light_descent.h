// SPDX-License-Identifier: Apache-2.0
// Gentle descent on the lobes of a light that is already nearly right: logarithms of colour and sharpness,
// and axes.
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "model/geometry/shape/hit.h"
#include "model/light/sg_mixture.h"

namespace cei3d {

class LightDescent {
 public:
  // keep_power: the light's total power per channel stays, so that a common factor cannot wander between
  // light and albedo.
  LightDescent(const SgMixture& light, float roughness, bool keep_power);

  // d_irradiance, d_reflected: gradient for what the free sky sends to each hit. One step, `rate` times the
  // full rates.
  void step(const Device&, std::span<const Hit> hits, std::span<const Vec3f> d_irradiance,
            std::span<const Vec3f> d_reflected, float rate);
  SgMixture light() const;

 private:
  Vec3f power() const;  // of all lobes, over the sphere
  int count_, padded_;
  float roughness_;
  bool keep_power_;
  int steps_ = 0;
  Vec3f first_power_;
  std::vector<float> planes_;  // [7][padded] axis, log sharpness, log colour
  std::vector<float> gradient_, m_, v_;
};

}  // namespace cei3d
