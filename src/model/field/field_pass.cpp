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
  float* y = const_cast<float*>(mlp_.output());
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

void scatter_encoding(const Device& device, const FieldConfig& config, int level, const float* points,
                      const float* d_encoding, int n, int columns, float* d_table) {
  const EncodingConfig& e = config.encoding;
  const int row = 3 + 6 * e.frequencies + 2 * level;
  device.launch<EncodeGridGrad>({{points, const_cast<float*>(d_encoding), encoding_rows(e), row, columns},
                                 grid_level(e, level),
                                 d_table},
                                n);
}

void points_to_panels(const Vec3f* points, int n, float* panels) {
  const int padded = (n + kPanel - 1) / kPanel * kPanel;
  for (int i = 0; i < padded; ++i) {
    const Vec3f p = i < n ? points[i] : Vec3f{0, 0, 0};
    for (int c = 0; c < 3; ++c) panels[panel_at(i, 1, 0, 3, c)] = p[c];
  }
}

}  // namespace cei3d
