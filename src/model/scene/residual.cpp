// SPDX-License-Identifier: Apache-2.0
#include "model/scene/residual.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/compute/kernels/radiance.h"

namespace cei3d {

namespace {

constexpr int kWidth = 64;

}  // namespace

Residual make_residual(std::shared_ptr<const Field> features, uint64_t seed, int layers) {
  Residual r;
  r.network = {.inputs = radiance_rows(features->config().outputs - 1),
               .hidden_layers = layers,
               .width = kWidth,
               .skip_layer = -1,
               .activation = Activation::relu,
               .softplus_beta = 1,
               .outputs = 3,
               .output_activation = Activation::none};
  r.features = std::move(features);
  add_mlp_params(r.network, r.params, seed);
  std::vector<Param>& all = r.params.all();
  for (size_t k = all.size() - 2; k < all.size(); ++k)  // the last layer
    std::fill(all[k].value.begin(), all[k].value.end(), 0.0f);
  return r;
}

ResidualPass::ResidualPass(const FieldConfig& features, const MlpConfig& network)
    : features_(features),
      values_(features, kMaxHits, 1),
      network_(network, kMaxHits, 1),
      points_(size_t(kMaxHits) * 3),
      directions_(size_t(kMaxHits) * 3),
      jets_(size_t(kMaxHits) * 4 * features.outputs),
      d_jets_(jets_.size()),
      d_input_(size_t(kMaxHits) * network.inputs) {}

int ResidualPass::forward(const Device& device, const Field& features, const MlpWeights& feature_weights,
                          const MlpWeights& weights, std::span<const Hit> hits) {
  const int n = int(hits.size()), samples = padded_to_panels(n), rows = features_.outputs;
  const auto hit = [&](int i) -> const Hit& { return hits[std::min(i, n - 1)]; };
  for (int i = 0; i < samples; ++i)
    for (int c = 0; c < 3; ++c) {
      points_[panel_at(i, 1, 0, 3, c)] = hit(i).position[c];
      directions_[panel_at(i, 1, 0, 3, c)] = -hit(i).to_camera[c];
    }
  values_.forward(device, features, feature_weights, points_.data(), samples, features_.encoding.levels,
                  rows);
  // The network reads jets; as their gradients it gets the normals that shading uses.
  for (int i = 0; i < samples; ++i) {
    for (int o = 0; o < rows; ++o)
      jets_[panel_at(i, 4, 0, rows, o)] = values_.output()[panel_at(i, 1, 0, rows, o)];
    for (int c = 0; c < 3; ++c) jets_[panel_at(i, 4, 1 + c, rows, 0)] = hit(i).normal[c];
  }
  device.launch<RadianceInput>({.points = points_.data(),
                                .directions = directions_.data(),
                                .jets = jets_.data(),
                                .input = network_.input(),
                                .features = rows - 1},
                               samples);
  network_.forward(device, weights, samples, weights.config().inputs, 3);
  return samples;
}

Vec3f ResidualPass::output(int hit) const {
  const auto at = [&](int c) { return network_.output()[panel_at(hit, 1, 0, 3, c)]; };
  return {at(0), at(1), at(2)};
}

void ResidualPass::set_output_grad(int hit, Vec3f d_output) {
  for (int c = 0; c < 3; ++c) network_.d_output()[panel_at(hit, 1, 0, 3, c)] = d_output[c];
}

void ResidualPass::backward(const Device& device, const MlpWeights& weights, int samples, float* gradient) {
  network_.backward(device, weights, samples, weights.config().inputs, gradient, d_input_.data());
}

void ResidualPass::backward_features(const Device& device, const MlpWeights& feature_weights, int samples,
                                     ChunkGradients& g) {
  const int rows = features_.outputs;
  std::fill(d_jets_.begin(), d_jets_.end(), 0.0f);
  device.launch<RadianceInputGrad>({.directions = directions_.data(),
                                    .jets = jets_.data(),
                                    .d_input = d_input_.data(),
                                    .d_jets = d_jets_.data(),
                                    .features = rows - 1},
                                   samples);
  float* d_value = values_.d_output();
  for (int i = 0; i < samples; ++i)
    for (int o = 0; o < rows; ++o)  // output 0, the distance, is not a feature
      d_value[panel_at(i, 1, 0, rows, o)] = o == 0 ? 0.0f : d_jets_[panel_at(i, 4, 0, rows, o)];
  g.reset(features_, feature_weights.gradient_size(), samples, 1);
  std::copy(points_.begin(), points_.begin() + std::ptrdiff_t(samples) * 3, g.points.begin());
  values_.backward(device, feature_weights, samples, features_.encoding.levels, g.network.data(),
                   g.d_encoding.data());
}

namespace {

constexpr int kGrain = 4096;

void add_network(const Device& device, const Residual& residual, std::span<const Hit> hits,
                 std::vector<Vec3f>& out) {
  const Field& features = *residual.features;
  const MlpWeights feature_weights(mlp_config(features.config()), features.params()),
      weights(residual.network, residual.params);
  parallel_ranges(int(hits.size()), kGrain, [&](int begin, int end) {
    ResidualPass pass(features.config(), residual.network);
    for (int first = begin; first < end; first += ResidualPass::kMaxHits) {
      const int n = std::min(ResidualPass::kMaxHits, end - first);
      std::vector<Hit> turned;
      for (const Hit& h : hits.subspan(size_t(first), size_t(n)))
        turned.push_back(with_rotated_directions(h, residual.room_from_object));
      pass.forward(device, features, feature_weights, weights, turned);
      for (int i = 0; i < n; ++i) out[first + i] += pass.output(i);
    }
  });
}

void add_images(const ResidualImages& images, std::span<const Hit> hits, bool smooth,
                std::vector<Vec3f>& out) {
  parallel_ranges(int(hits.size()), kGrain, [&](int begin, int end) {
    for (int i = begin; i < end; ++i) out[i] += smooth ? images.smooth_at(hits[i]) : images.at(hits[i]);
  });
}

}  // namespace

std::vector<Vec3f> residual_at(const Device& device, const Residual& residual, std::span<const Hit> hits,
                               bool smooth) {
  std::vector<Vec3f> out(hits.size(), Vec3f{0, 0, 0});
  if (residual.features) add_network(device, residual, hits, out);
  if (residual.images) add_images(*residual.images, hits, smooth, out);
  return out;
}

}  // namespace cei3d
