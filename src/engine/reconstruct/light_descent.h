// SPDX-License-Identifier: Apache-2.0
// Gentle descent on the lobes of a light that is already nearly right: logarithms of colour and sharpness, and axes.
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "model/geometry/hit.h"
#include "model/light/sg_mixture.h"

namespace cei3d {

class LightDescent {
 public:
  struct Rates {
    float color = 3e-3f, sharpness = 3e-3f, axis = 5e-4f;  // of Adam
  };
  LightDescent(const SgMixture& light, float roughness, const Rates& rates);

  // d_irradiance, d_reflected: gradient for what the free sky sends to each hit. One step, `rate` times the rates.
  void step(const Device&, std::span<const Hit> hits, std::span<const Vec3f> d_irradiance,
            std::span<const Vec3f> d_reflected, float rate);
  SgMixture light() const;

 private:
  int count_, padded_;
  float roughness_;
  Rates rates_;
  int steps_ = 0;
  std::vector<float> planes_;                  // [7][padded] axis, log sharpness, log colour
  std::vector<float> gradient_, m_, v_;
};

}  // namespace cei3d
