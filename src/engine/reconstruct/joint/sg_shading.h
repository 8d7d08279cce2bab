// SPDX-License-Identifier: Apache-2.0
// The paper's forward rendering: diffuse light without occlusion, and reflection by one spherical Gaussian;
// and the descent on its material. [paper eq. 13-15; core/math/single_sg.h]
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/reconstruct/joint/sg_material.h"
#include "engine/render/lighting.h"
#include "model/field/adam_constants.h"
#include "model/field/optimizer.h"

namespace cei3d {

class SgShading {
 public:
  // rate: of Adam, on logarithms of sharpness and amplitude and on logits of the rest.
  SgShading(const Device&, const SgMaterial& start, float rate, AdamConstants adam = {});

  SgMaterial material() const;
  // The radiance of hits as a linear function of their albedo. The materials of the batch are not read.
  std::vector<ShadingTerms<float>> terms(const SgMixture& light, const HitBatch&);
  // The adjoint, for the same batch. Accumulates dL/d(material).
  ShadingGrads grad(const HitBatch&, std::span<const Vec3f> albedo, std::span<const Vec3f> d_radiance);
  // dL/d(lobes) of the last grad(), as of lobes_grad() (appearance/light_descent.h).
  const std::vector<float>& lobes_grad() const { return d_lobes_; }
  void update(float rate);  // times the full rate

  void save(Tensors& out, const std::string& prefix) const;
  void load(const Tensors& in, const std::string& prefix);

 private:
  friend struct JointDescentProbe;
  struct Points;  // a batch as planes
  Points points_of(const HitBatch&) const;
  LobePlanes lobes() const;
  double light_grad(const HitBatch&, const Points&, std::span<const Vec3f> d_mirrored, ShadingGrads&);

  const Device& device_;
  ParamSet params_;
  Param* raw_;  // logarithms of sharpness and amplitude (3), logits of roughness, specular, metalness
  Optimizer optimizer_;
  std::vector<float> lobes_, d_lobes_;  // of the last terms(); of the last grad()
  int n_lobes_ = 0;
  std::vector<Vec3f> irradiance_, mirrored_;  // of the last terms()
};

}  // namespace cei3d
