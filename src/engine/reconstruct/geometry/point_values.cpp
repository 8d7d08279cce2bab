// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry/point_values.h"

#include <algorithm>

#include "core/compute/kernels/panel.h"

namespace cei3d {

PointValues::PointValues(const FieldConfig& sdf)
    : rows_(sdf.outputs), pass_(sdf, kBlock, 1), points_(size_t(kBlock) * 3) {}

void PointValues::eval(const GeometryNetworks& n, std::span<const Vec3f> x, std::span<float> out) {
  for (size_t begin = 0; begin < x.size(); begin += kBlock) {
    const int count = int(std::min(size_t(kBlock), x.size() - begin));
    points_to_panels(&x[begin], count, points_.data());
    pass_.forward(n.device, n.sdf, n.sdf_weights, points_.data(), padded_to_panels(count), n.levels, 1);
    for (int i = 0; i < count; ++i) out[begin + i] = pass_.output()[panel_at(i, 1, 0, rows_, 0)];
  }
}

void PointValues::gradient(const GeometryNetworks& n, std::span<const Vec3f> x,
                           const std::function<float(int, float)>& d_value, ChunkGradients& g) {
  const int count = int(x.size());
  g.reset(n.sdf.config(), n.sdf_weights.gradient_size(), count, 1);
  points_to_panels(x.data(), count, g.points.data());
  pass_.forward(n.device, n.sdf, n.sdf_weights, g.points.data(), g.padded, n.levels, rows_);
  float* d_output = pass_.d_output();
  std::fill(d_output, d_output + size_t(g.padded) * rows_, 0.0f);
  for (int i = 0; i < count; ++i) {
    const size_t at = panel_at(i, 1, 0, rows_, 0);
    d_output[at] = d_value(i, pass_.output()[at]);
  }
  pass_.backward(n.device, n.sdf_weights, g.padded, n.levels, g.network.data(), g.d_encoding.data());
}

}  // namespace cei3d
