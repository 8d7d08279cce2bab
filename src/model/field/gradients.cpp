// SPDX-License-Identifier: Apache-2.0
#include "model/field/gradients.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/compute/kernels/encode.h"

namespace cei3d {

void ChunkGradients::reset(const FieldConfig& config, size_t network_size, int n, int columns_in) {
  padded = padded_to_panels(n);
  columns = columns_in;
  points.resize(size_t(padded) * 3);
  d_encoding.resize(size_t(padded) * columns * encoding_rows(config.encoding));
  network.assign(network_size, 0.0f);
}

namespace {

// Adds the gradients of one chunk to those of the table of a level.
void scatter_encoding(const Device& device, const EncodingConfig& e, int level, const ChunkGradients& c,
                      float* d_table) {
  const EncodeGradArgs where{.points = c.points.data(),
                             .d_out = c.d_encoding.data(),
                             .stride = encoding_rows(e),
                             .row = 3 + 6 * e.frequencies + 2 * level,
                             .columns = c.columns};
  device.launch<EncodeGridGrad>({where, grid_level(e, level), d_table}, c.padded);
}

}  // namespace

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
      scatter_encoding(device, field.config().encoding, level, c, d_table);
  });
}

}  // namespace cei3d
