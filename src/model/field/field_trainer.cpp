// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/base/parallel.h"
#include "core/base/pool.h"
#include "core/compute/kernels/panel.h"
#include "model/field/field.h"
#include "model/field/field_pass.h"
#include "model/field/gradients.h"
#include "model/field/optimizer.h"

namespace cei3d {

namespace {
constexpr int kChunk = 512;
}

struct FieldTrainer::State {
  Optimizer optimizer;
  Pool<FieldPass> passes;
  std::vector<ChunkGradients> chunks;
};

FieldTrainer::FieldTrainer(Field& field, const Options& options)
    : field_(field),
      options_(options),
      state_(new State{{},
                       Pool<FieldPass>([config = field.config()] {
                         return std::make_unique<FieldPass>(config, kChunk, 1);
                       }),
                       {}}) {
  Optimizer::Group tables{options.encoding_rate}, layers{options.network_rate};
  tables.skip_zero = true;
  state_->optimizer.add(field.params(), "encoding/", tables);
  state_->optimizer.add(field.params(), "layer", layers);
}
FieldTrainer::~FieldTrainer() = default;

void FieldTrainer::step(const Device& device, std::span<const Vec3f> x, const Loss& loss, float rate,
                        int levels) {
  const FieldConfig& config = field_.config();
  const MlpWeights weights(mlp_config(config), field_.params());
  const int n = int(x.size()), outputs = config.outputs;
  if (levels < 0) levels = config.encoding.levels;
  const int chunks = (n + kChunk - 1) / kChunk;
  state_->chunks.resize(chunks);
  parallel_for(chunks, [&](int c) {
    const int begin = c * kChunk, end = std::min(n, begin + kChunk), count = end - begin;
    ChunkGradients& g = state_->chunks[c];
    g.reset(config, weights.gradient_size(), count, 1);
    points_to_panels(&x[begin], count, g.points.data());
    state_->passes.with([&](FieldPass& pass) {
      pass.forward(device, field_, weights, g.points.data(), g.padded, levels, outputs);
      std::vector<float> y(size_t(count) * outputs), d_y(size_t(count) * outputs, 0.0f);
      for (int i = 0; i < count; ++i)
        for (int o = 0; o < outputs; ++o)
          y[size_t(i) * outputs + o] = pass.output()[panel_at(i, 1, 0, outputs, o)];
      loss(begin, end, y.data(), d_y.data());
      for (int i = 0; i < g.padded; ++i)
        for (int o = 0; o < outputs; ++o)
          pass.d_output()[panel_at(i, 1, 0, outputs, o)] = i < count ? d_y[size_t(i) * outputs + o] : 0.0f;
      pass.backward(device, weights, g.padded, levels, g.network.data(), g.d_encoding.data());
    });
  });
  accumulate_gradients(device, field_, state_->chunks, levels, state_->optimizer);
  state_->optimizer.step(device, rate);
}

}  // namespace cei3d
