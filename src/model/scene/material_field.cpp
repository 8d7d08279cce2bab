// SPDX-License-Identifier: Apache-2.0
#include "model/scene/material_field.h"

#include "core/math/roughness.h"

namespace cei3d {
namespace {

constexpr float kCutOff = 0.1f;  // metalness within this of 0 or 1 counts as 0 or 1

}  // namespace

Material material_of(const float* outputs, float specular) {
  return {roughness_of_share(outputs[0]), specular,
          clamp((outputs[1] - kCutOff) / (1 - 2 * kCutOff), 0.0f, 1.0f)};
}

void material_of_grad(const float* outputs, const Material& d, float* d_outputs) {
  d_outputs[0] = d.roughness * kRoughnessRange;
  const bool cut = outputs[1] < kCutOff || outputs[1] > 1 - kCutOff;
  d_outputs[1] = cut ? 0 : d.metalness / (1 - 2 * kCutOff);
}

FieldTrainer::Loss material_loss(std::span<const Material> d_material) {
  return [=](int begin, int end, const float* out, float* d_out) {
    constexpr int kOutputs = MaterialField::kOutputs;
    for (int i = begin; i < end; ++i, out += kOutputs, d_out += kOutputs)
      material_of_grad(out, d_material[size_t(i)], d_out);
  };
}

void outputs_for(const Material& m, float* outputs) {
  outputs[0] = clamp(share_of_roughness(m.roughness), 0.0f, 1.0f);
  outputs[1] = m.metalness <= 0 ? 0 : m.metalness >= 1 ? 1 : kCutOff + (1 - 2 * kCutOff) * m.metalness;
}

std::vector<Material> MaterialField::at(const Device& device, std::span<const Vec3f> points) const {
  if (!varying_) return {points.size(), mean_};
  std::vector<float> outputs(kOutputs * points.size());
  varying_->eval(device, points, outputs);
  std::vector<Material> out(points.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = material_of(&outputs[kOutputs * i], mean_.specular);
  return out;
}

}  // namespace cei3d
