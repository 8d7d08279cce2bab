// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry/volume_renderer.h"

#include <algorithm>

#include "core/compute/kernels/radiance.h"

namespace cei3d {

MlpConfig radiance_config(const GeometryOptions& o) {
  return {.inputs = radiance_rows(o.sdf.outputs - 1),
          .hidden_layers = o.radiance_layers,
          .width = o.radiance_width,
          .skip_layer = -1,
          .activation = Activation::relu,
          .softplus_beta = 1,
          .outputs = 3,
          .output_activation = Activation::sigmoid};
}

VolumeRenderer::VolumeRenderer(const GeometryOptions& o)
    : sdf_(o.sdf),
      rows_(o.sdf.outputs),
      inputs_(radiance_config(o).inputs),
      jet_(o.sdf, kChunkSamples, 4),
      color_(radiance_config(o), kChunkSamples, 1),
      points_(size_t(kChunkSamples) * 3),
      directions_(size_t(kChunkSamples) * 3),
      rotations_(size_t(kChunkSamples) * 9),
      d_color_input_(size_t(kChunkSamples) * inputs_) {}

void VolumeRenderer::forward(const GeometryNetworks& n, const GeometrySchedule& s, const RayBatch& batch,
                             const RaySamples& samples) {
  place(s, batch, samples);
  jet_.forward(n.device, n.sdf, n.sdf_weights, points_.data(), padded_, n.levels, rows_);
  n.device.launch<RadianceInput>({.points = points_.data(),
                                  .directions = directions_.data(),
                                  .jets = jet_.output(),
                                  .input = color_.input(),
                                  .features = rows_ - 1,
                                  .rotations = turns(batch)},
                                 padded_);
  color_.forward(n.device, n.radiance_weights, padded_, inputs_, 3);
  composite(s, batch, samples);
}

void VolumeRenderer::place(const GeometrySchedule& s, const RayBatch& batch, const RaySamples& samples) {
  const Vec3f none{0, 0, 0};
  padded_ = padded_to_panels(samples.count());
  for (int r = 0; r < batch.count(); ++r)
    for (int i = samples.first[r]; i < samples.first[r + 1]; ++i) {
      const Ray& ray = batch.rays[r];
      store_point(points_.data(), i, ray.origin + ray.direction * samples.depths[i]);
      store_point(directions_.data(), i, s.view_dependent ? ray.direction : none);
      if (turns(batch)) store_rotation(rotations_.data(), i, batch.room_from_object[r]);
    }
  for (int i = samples.count(); i < padded_; ++i) {
    store_point(points_.data(), i, none);
    store_point(directions_.data(), i, none);
  }
}

void VolumeRenderer::composite(const GeometrySchedule& s, const RayBatch& batch, const RaySamples& samples) {
  alphas_.clear();
  weights_.clear();
  pixels_.clear();
  coverage_.clear();
  depths_.clear();
  for (int r = 0; r < batch.count(); ++r) {
    Composite<float> ray(batch.backgrounds[r]);
    float depth = 0;
    for (int i = samples.first[r]; i < samples.first[r + 1]; ++i) {
      const float cosine = dot(jets().gradient(i), batch.rays[r].direction);
      alphas_.push_back(neus_alpha(jets().value(i), cosine, s.step, s.inv_s));
      weights_.push_back(ray.add(alphas_.back().alpha, color(i)));
      depth += weights_.back().weight * samples.depths[i];
    }
    pixels_.push_back(ray.pixel);
    coverage_.push_back(ray.coverage);
    depths_.push_back(ray.coverage > 0.5f ? depth / ray.coverage : 0);
  }
}

void VolumeRenderer::backward_composite(const RayBatch& batch, const RaySamples& samples,
                                        std::span<const Vec3f> d_pixels) {
  float *d_jet = jet_.d_output(), *d_color = color_.d_output();
  std::fill(d_jet, d_jet + size_t(padded_) * 4 * rows_, 0.0f);
  std::fill(d_color, d_color + size_t(padded_) * 3, 0.0f);
  for (int r = 0; r < batch.count(); ++r) {
    CompositeGrad<float> ray(batch.backgrounds[r], d_pixels[r]);
    for (int i = samples.first[r + 1] - 1; i >= samples.first[r]; --i) {
      const NeusSample<float>& alpha = alphas_[i];
      const CompositeSampleGrad<float> d = ray.add(alpha.alpha, weights_[i], color(i));
      store_point(d_color, i, d.d_color);
      d_jets().add_value(i, d.d_alpha * alpha.d_sdf);
      d_jets().add_gradient(i, (d.d_alpha * alpha.d_cosine) * batch.rays[r].direction);
    }
  }
}

void VolumeRenderer::backward_networks(const GeometryNetworks& n, const RayBatch& batch, ChunkGradients& sdf,
                                       std::vector<float>& radiance) {
  radiance.assign(n.radiance_weights.gradient_size(), 0.0f);
  color_.backward(n.device, n.radiance_weights, padded_, inputs_, radiance.data(), d_color_input_.data());
  n.device.launch<RadianceInputGrad>({.directions = directions_.data(),
                                      .jets = jet_.output(),
                                      .d_input = d_color_input_.data(),
                                      .d_jets = jet_.d_output(),
                                      .features = rows_ - 1,
                                      .rotations = turns(batch)},
                                     padded_);
  sdf.reset(sdf_, n.sdf_weights.gradient_size(), padded_, 4);
  std::copy(points_.begin(), points_.begin() + std::ptrdiff_t(padded_) * 3, sdf.points.begin());
  jet_.backward(n.device, n.sdf_weights, padded_, n.levels, sdf.network.data(), sdf.d_encoding.data());
}

}  // namespace cei3d
