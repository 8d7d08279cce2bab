// SPDX-License-Identifier: Apache-2.0
// Descent on the lobes of a light that is already nearly right: on the logarithms of color and sharpness, and
// on the axes.
#pragma once

#include <span>
#include <vector>

#include "engine/render/lighting.h"
#include "model/field/adam_constants.h"
#include "model/field/optimizer.h"

namespace cei3d {

// dL/d(lobes) as planes [7][lobes.padded] (axis, sharpness, color), from dL/d(the light that the environment
// sends to each hit where nothing occludes it). Axes count as vectors of any length.
std::vector<float> lobes_grad(const Device&, const LobePlanes& lobes, const HitBatch&,
                              std::span<const Vec3f> d_irradiance, std::span<const Vec3f> d_reflected);

class LightDescent {
 public:
  // keep_power: the total power per channel stays as it is, so that no common factor moves between light and
  // albedo; the gradient is taken along that constraint.
  LightDescent(const SgMixture& light, bool keep_power, AdamConstants adam = {.eps = 1e-12f});

  // One step at `rate` times the full rates. d_irradiance, d_reflected: as in lobes_grad().
  void step(const Device&, const HitBatch&, std::span<const Vec3f> d_irradiance,
            std::span<const Vec3f> d_reflected, float rate);
  // One step from a gradient. d_lobes: what lobes_grad() returns for the present lobes.
  void step(const Device&, const std::vector<float>& d_lobes, float rate);
  SgMixture light() const;

  void save(Tensors& out, const std::string& prefix) const;
  void load(const Tensors& in, const std::string& prefix);  // into a descent on as many lobes

 private:
  std::vector<float> lobe_planes() const;
  void set_gradient(const std::vector<float>& lobes, const std::vector<float>& d_lobes);
  void normalize_lobes();
  void restore_power();
  Vec3f power_of(int lobe) const;
  Vec3f total_power() const;

  int count_, padded_;
  bool keep_power_;
  Vec3f first_power_;
  ParamSet params_;
  Param *axes_, *logs_;  // planes [3][padded]; [4][padded]: logarithms of sharpness and power
  Optimizer optimizer_;
};

}  // namespace cei3d
