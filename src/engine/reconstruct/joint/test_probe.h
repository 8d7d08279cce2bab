// SPDX-License-Identifier: Apache-2.0
// For tests: parameters and gradients inside the joint descent.
#pragma once

#include <span>
#include <vector>

#include "engine/reconstruct/joint/joint_descent.h"

namespace cei3d {

struct JointDescentProbe {
  struct Step {
    JointLoss loss;
    std::vector<Hit> hits;
    std::vector<Material> materials;
    ShadingGrads grads{0};
  };
  static Step accumulate(JointDescent& d) {
    if (!d.lighting_) d.relight();
    JointDescent::Shaded shaded;
    const JointLoss loss = d.accumulate(0, shaded);
    return {loss, shaded.hits, shaded.materials, shaded.grads};
  }
  static ParamSet& sdf(JointDescent& d) { return d.object_.sdf.params(); }
  static ParamSet& albedo(JointDescent& d) { return d.object_.albedo.params(); }
  static ParamSet& materials(JointDescent& d) { return d.material_.varying_->params(); }
  static std::span<const float> sdf_gradient(JointDescent& d, const Param& p) {
    return d.sdf_trainer_.gradient(p);
  }
  static std::span<const float> albedo_gradient(JointDescent& d, const Param& p) {
    return d.albedo_trainer_.gradient(p);
  }
  static std::span<const float> materials_gradient(JointDescent& d, const Param& p) {
    return d.material_.trainer_->gradient(p);
  }
  static std::vector<float>& gloss(JointDescent& d) { return d.gloss_->raw_->value; }
  static std::vector<float> gloss_gradient(JointDescent& d) { return gloss_gradient(*d.gloss_); }
  static std::vector<float> gloss_gradient(SgShading& gloss) {
    const std::span<const float> g = gloss.optimizer_.gradient(*gloss.raw_);
    return {g.begin(), g.end()};
  }
  static std::vector<float> gloss_lobes_gradient(JointDescent& d) { return d.gloss_->lobes_grad(); }
  static Param& logits(JointDescent& d) { return *d.material_.logits_; }
  static std::span<const float> logits_gradient(JointDescent& d) {
    return d.material_.optimizer_.gradient(*d.material_.logits_);
  }
  static void use_logits(JointDescent& d) { d.object_.material = d.material_.from_logits(); }
  static void set_light(JointDescent& d, const SgMixture& light) {
    d.lighting_->set_lobes(light);
    d.object_.light = light;
  }
};

}  // namespace cei3d
