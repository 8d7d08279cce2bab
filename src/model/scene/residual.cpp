// SPDX-License-Identifier: Apache-2.0
#include "model/scene/residual.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/compute/kernels/radiance.h"

namespace cei3d {

namespace {

constexpr int kLayers = 2, kWidth = 64;

}  // namespace

Residual make_residual(const FieldConfig& sdf, uint64_t seed) {
  Residual r;
  r.network = {radiance_rows(sdf.outputs - 1), kLayers, kWidth, -1, Activation::relu, 1, 3, Activation::none};
  add_mlp_params(r.network, r.params, seed);
  std::vector<Param>& all = r.params.all();
  for (size_t k = all.size() - 2; k < all.size(); ++k)  // the last layer
    std::fill(all[k].value.begin(), all[k].value.end(), 0.0f);
  return r;
}

ResidualPass::ResidualPass(const FieldConfig& sdf, const MlpConfig& network)
    : sdf_(sdf),
      values_(sdf, kMost, 1),
      network_(network, kMost, 1),
      points_(size_t(kMost) * 3),
      directions_(size_t(kMost) * 3),
      jets_(size_t(kMost) * 4 * sdf.outputs) {}

int ResidualPass::forward(const Device& device, const Field& sdf, const MlpWeights& sdf_weights,
                          const MlpWeights& weights, std::span<const Hit> hits) {
  const int n = int(hits.size()), samples = (n + kPanel - 1) / kPanel * kPanel, rows = sdf_.outputs;
  const auto hit = [&](int i) -> const Hit& { return hits[std::min(i, n - 1)]; };
  for (int i = 0; i < samples; ++i)
    for (int c = 0; c < 3; ++c) {
      points_[panel_at(i, 1, 0, 3, c)] = hit(i).position[c];
      directions_[panel_at(i, 1, 0, 3, c)] = -hit(i).to_camera[c];
    }
  values_.forward(device, sdf, sdf_weights, points_.data(), samples, sdf_.encoding.levels, rows);
  // The network reads jets; their slopes are the normals that shading uses.
  for (int i = 0; i < samples; ++i) {
    for (int o = 0; o < rows; ++o)
      jets_[panel_at(i, 4, 0, rows, o)] = values_.output()[panel_at(i, 1, 0, rows, o)];
    for (int c = 0; c < 3; ++c) jets_[panel_at(i, 4, 1 + c, rows, 0)] = hit(i).normal[c];
  }
  device.launch<RadianceInput>(
      {points_.data(), directions_.data(), jets_.data(), nullptr, network_.input(), rows - 1}, samples);
  network_.forward(device, weights, samples, weights.config().inputs, 3);
  return samples;
}

Vec3f ResidualPass::output(int hit) const {
  const auto at = [&](int c) { return network_.output()[panel_at(hit, 1, 0, 3, c)]; };
  return {at(0), at(1), at(2)};
}

void ResidualPass::set_slope(int hit, Vec3f slope) {
  for (int c = 0; c < 3; ++c) network_.d_output()[panel_at(hit, 1, 0, 3, c)] = slope[c];
}

void ResidualPass::backward(const Device& device, const MlpWeights& weights, int samples, float* gradient) {
  network_.backward(device, weights, samples, weights.config().inputs, gradient, nullptr);
}

std::vector<Vec3f> residual_at(const Device& device, const Field& sdf, const Residual& residual,
                               std::span<const Hit> hits) {
  constexpr int kGrain = 4096;
  std::vector<Vec3f> out(hits.size());
  const MlpWeights sdf_weights(mlp_config(sdf.config()), sdf.params()),
      weights(residual.network, residual.params);
  parallel_ranges(int(hits.size()), kGrain, [&](int begin, int end) {
    ResidualPass pass(sdf.config(), residual.network);
    for (int first = begin; first < end; first += ResidualPass::kMost) {
      const int n = std::min(ResidualPass::kMost, end - first);
      pass.forward(device, sdf, sdf_weights, weights, hits.subspan(size_t(first), size_t(n)));
      for (int i = 0; i < n; ++i) out[first + i] = pass.output(i);
    }
  });
  return out;
}

}  // namespace cei3d
