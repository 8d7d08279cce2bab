// SPDX-License-Identifier: Apache-2.0
#include "model/field/gradients.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/compute/kernels/panel.h"
#include "model/field/field_pass.h"

namespace cei3d {

void ChunkGradients::reset(const FieldConfig& config, size_t network_size, int n, int columns_in) {
  padded = padded_to_panels(n);
  columns = columns_in;
  points.resize(size_t(padded) * 3);
  d_encoding.resize(size_t(padded) * columns * encoding_rows(config.encoding));
  network.assign(network_size, 0.0f);
}

void accumulate_layers(const ParamSet& params, const std::vector<const std::vector<float>*>& network,
                       Optimizer& optimizer) {
  size_t offset = 0;
  for (const Param& p : params.all()) {
    if (!p.name.starts_with("layer")) continue;
    const std::span<float> g = optimizer.gradient(p);
    for (const auto* chunk : network)
      for (size_t i = 0; i < p.count(); ++i) g[i] += (*chunk)[offset + i];
    offset += p.count();
  }
}

void accumulate_gradients(const Device& device, const Field& field, const std::vector<ChunkGradients>& chunks,
                          int levels, Optimizer& optimizer) {
  std::vector<const std::vector<float>*> network;
  for (const ChunkGradients& c : chunks) network.push_back(&c.network);
  accumulate_layers(field.params(), network, optimizer);
  parallel_for(levels, [&](int level) {
    float* d_table = optimizer.gradient(field.params().get("encoding/level" + std::to_string(level))).data();
    for (const ChunkGradients& c : chunks)
      scatter_encoding(device, field.config(), level, c.points.data(), c.d_encoding.data(), c.padded,
                       c.columns, d_table);
  });
}

}  // namespace cei3d
