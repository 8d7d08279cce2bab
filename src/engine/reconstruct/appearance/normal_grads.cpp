// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/normal_grads.h"

#include "core/math/rng.h"
#include "engine/reconstruct/appearance/sample_grad.h"
#include "engine/render/lighting.h"
#include "engine/render/render.h"
#include "model/geometry/shape/sdf_normals.h"

namespace cei3d {

NormalGrads::NormalGrads(const Device& device, const AppearanceInput& input,
                         const AppearanceResult& appearance, const PolishOptions& options,
                         const Progress& progress)
    : device_(device),
      samples_(input.samples),
      material_(appearance.material),
      options_(options),
      albedo_(*appearance.albedo),
      trainer_(albedo_, {}),
      lighting_(device, input.surface, appearance.light,
                turned_vertex_lights(Transport(input.surface, {}, progress), appearance.light,
                                     {albedo_.eval3(device, input.surface->mesh().positions),
                                      appearance.material.at(device, input.surface->mesh().positions)},
                                     input.samples.turned.turns)) {}

ValueGradSpans NormalGrads::at(const Field& sdf, int step) {
  choose_batch(step);
  refine_hits(device_, sdf, directions_, hits_, edges_);
  const std::vector<Vec3f> positions = positions_of(hits_);
  const std::vector<Material> materials = material_.at(device_, positions);
  const std::vector<uint16_t> views = views_of(samples_.turned, batch_);
  const HitBatch batch{hits_, materials, {samples_.turned.turns, views}};
  const std::vector<IncidentLight<float>> light = lighting_.incident_light(batch);
  fit_albedo(positions, lighting_.terms(batch, light));
  std::vector<Vec3f> d_normals = lighting_.grad(batch, light, colors_, d_radiance_).d_normal;
  for (Vec3f& d : d_normals) d = d * options_.weight;
  points_.clear();
  value_grads_.clear();
  add_value_grads(sdf.config(), positions, d_normals, edges_, points_, value_grads_);
  return {points_, value_grads_};
}

void NormalGrads::save(Tensors& out) const {
  albedo_.params().save(out, "albedo");
  trainer_.save(out, "albedo_adam");
}

void NormalGrads::load(const Tensors& in) {
  albedo_.params().load(in, "albedo");
  trainer_.load(in, "albedo_adam");
}

void NormalGrads::choose_batch(int step) {
  const int n = options_.batch;
  batch_.resize(n);
  hits_.resize(n);
  directions_.resize(n);
  edges_.resize(n);
  for (int i = 0; i < n; ++i) {
    batch_[i] =
        Rng(options_.seed ^ 0x9011, uint64_t(step), uint64_t(i)).below(uint32_t(samples_.hits.size()));
    hits_[i] = samples_.hits[batch_[i]];
    directions_[i] = -hits_[i].to_camera;
  }
}

// One step of the albedo, which has compensated wrong normals and would keep them. Sets colors_ and
// d_radiance_.
void NormalGrads::fit_albedo(const std::vector<Vec3f>& positions,
                             const std::vector<ShadingTerms<float>>& terms) {
  colors_.resize(hits_.size());
  d_radiance_.resize(hits_.size());
  const auto loss = [&](int begin, int end, const float* out, float* d_out) {
    for (int i = begin; i < end; ++i) {
      const float* a = out + 3 * (i - begin);
      colors_[i] = {a[0], a[1], a[2]};
      const SampleGrad g = sample_grad(samples_, batch_[i], terms[i], colors_[i], 1 / float(options_.batch));
      d_radiance_[i] = g.d_radiance;
      for (int c = 0; c < 3; ++c) d_out[3 * (i - begin) + c] = g.d_albedo[c];
    }
  };
  trainer_.step(device_, positions, loss, 0.1f);
}

}  // namespace cei3d
