// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/joint/material_descent.h"

#include <cmath>

#include "core/math/activation.h"
#include "core/math/roughness.h"
#include "engine/reconstruct/joint/logit.h"

namespace cei3d {
namespace {

constexpr float kFullRate = 1e-2f;

}  // namespace

MaterialDescent::MaterialDescent(const MaterialField& start, float rate, bool learn_specular,
                                 AdamConstants adam)
    : field_(start), rate_(rate) {
  if (start.varying()) {
    varying_ = std::make_shared<Field>(*start.varying());
    field_ = {start.mean(), varying_};
    trainer_ = std::make_unique<FieldTrainer>(*varying_, FieldTrainer::Options{.adam = adam});
    return;
  }
  const Material& m = start.mean();
  logits_ = &params_.add("logits", {3});
  logits_->value[0] = logit(share_of_roughness(m.roughness));
  logits_->value[1] = logit(m.specular);
  logits_->value[2] = logit(m.metalness);
  learned_[0] = true;
  learned_[1] = learn_specular;
  learned_[2] = m.metalness > 0 && m.metalness < 1;
  optimizer_.add(params_, "", {.rate = kFullRate, .adam = adam});
}

Material MaterialDescent::from_logits() const {
  const Material& m = field_.mean();
  const float* v = logits_->value.data();
  return {learned_[0] ? roughness_of_share(share_of_logit(v[0])) : m.roughness,
          learned_[1] ? share_of_logit(v[1]) : m.specular, learned_[2] ? share_of_logit(v[2]) : m.metalness};
}

void MaterialDescent::accumulate(const Device& device, std::span<const Vec3f> positions,
                                 std::span<const Material> d_material) {
  if (varying_) {
    trainer_->accumulate(device, positions, material_loss(d_material));
    return;
  }
  double sum[3] = {};
  for (const Material& d : d_material) sum[0] += d.roughness, sum[1] += d.specular, sum[2] += d.metalness;
  const std::span<float> gradient = optimizer_.gradient(*logits_);
  for (int k = 0; k < 3; ++k) {
    const float share_d_logit = Sigmoid::eval(logits_->value[size_t(k)], 1).first;
    if (learned_[k]) gradient[size_t(k)] += float(sum[k]) * share_d_logit * (k == 0 ? kRoughnessRange : 1);
  }
}

void MaterialDescent::update(const Device& device, float rate) {
  if (varying_) {
    trainer_->update(device, rate * rate_ / kFullRate);
    return;
  }
  optimizer_.step(device, rate * rate_ / kFullRate);
  field_ = MaterialField(from_logits());
}

void MaterialDescent::save(Tensors& out, const std::string& prefix) const {
  if (varying_) {
    varying_->params().save(out, prefix);
    trainer_->save(out, prefix + "_adam");
    return;
  }
  params_.save(out, prefix);
  optimizer_.save(out, prefix + "_adam");
}

void MaterialDescent::load(const Tensors& in, const std::string& prefix) {
  if (varying_) {
    varying_->params().load(in, prefix);
    trainer_->load(in, prefix + "_adam");
    return;
  }
  params_.load(in, prefix);
  optimizer_.load(in, prefix + "_adam");
  field_ = MaterialField(from_logits());
}

}  // namespace cei3d
