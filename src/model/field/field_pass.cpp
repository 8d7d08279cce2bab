// SPDX-License-Identifier: Apache-2.0
#include "model/field/field_pass.h"

#include <cmath>

#include "core/compute/kernels/encode.h"

namespace cei3d {

FieldPass::FieldPass(const FieldConfig& config, int capacity, int columns)
    : config_(config), columns_(columns), mlp_(mlp_config(config), capacity, columns) {}

int FieldPass::active_rows(int levels) const { return 3 + 6 * config_.encoding.frequencies + 2 * levels; }

void FieldPass::forward(const Device& device, const Field& field, const MlpWeights& weights,
                        const float* points, int n, int levels, int outputs) {
  const EncodingConfig& e = config_.encoding;
  EncodeArgs a{points, mlp_.input(), encoding_rows(e), 0, columns_};
  device.launch<EncodePoint>(a, n);
  a.row = 3;
  for (int k = 0; k < e.frequencies; ++k, a.row += 6) device.launch<EncodeFrequency>({a, k}, n);
  for (int l = 0; l < levels; ++l, a.row += 2)
    device.launch<EncodeGrid>({a, grid_level(e, l), field.table(l)}, n);
  mlp_.forward(device, weights, n, active_rows(levels), outputs);
  if (config_.sphere_radius > 0) add_sphere(points, n);
}

void FieldPass::add_sphere(const float* points, int n) {
  float* y = mlp_.mutable_output();
  for (int i = 0; i < n; ++i) {
    const Vec3f p = load_point<float>(points, i);
    const float r = length(p);
    y[panel_at(i, columns_, 0, config_.outputs, 0)] += r - config_.sphere_radius;
    for (int c = 1; c < columns_; ++c)
      y[panel_at(i, columns_, c, config_.outputs, 0)] += p[c - 1] / std::max(r, 1e-9f);
  }
}

void FieldPass::backward(const Device& device, const MlpWeights& weights, int n, int levels,
                         float* network_gradient, float* d_encoding) {
  mlp_.backward(device, weights, n, active_rows(levels), network_gradient, d_encoding);
}

void points_to_panels(const Vec3f* points, int n, float* panels) {
  for (int i = 0; i < padded_to_panels(n); ++i) store_point(panels, i, i < n ? points[i] : Vec3f{0, 0, 0});
}

}  // namespace cei3d
