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
constexpr int kChunk = 512;     // points of a task
constexpr int kJetColumns = 4;  // the value and three derivatives
}  // namespace

struct FieldTrainer::State {
  explicit State(const FieldConfig& config)
      : values([config] { return std::make_unique<FieldPass>(config, kChunk, 1); }),
        jets([config] { return std::make_unique<FieldPass>(config, kChunk, kJetColumns); }) {}
  Optimizer optimizer;
  Pool<FieldPass> values, jets;
  std::vector<ChunkGradients> chunks;
};

FieldTrainer::FieldTrainer(Field& field, const Options& options)
    : field_(field), options_(options), state_(new State(field.config())) {
  Optimizer& optimizer = state_->optimizer;
  optimizer.add(field.params(), "encoding/",
                {.rate = options.encoding_rate, .adam = options.adam, .skip_zero = true});
  optimizer.add(field.params(), "layer", {.rate = options.network_rate, .adam = options.adam});
}
FieldTrainer::~FieldTrainer() = default;

void FieldTrainer::save(Tensors& out, const std::string& prefix) const {
  state_->optimizer.save(out, prefix);
}
void FieldTrainer::load(const Tensors& in, const std::string& prefix) { state_->optimizer.load(in, prefix); }

// Adds the gradients of all chunks of points. chunk(pass, first point, number of points): reads the outputs
// of the pass and writes all of its d_output().
template <class Chunk>
void FieldTrainer::for_chunks(const Device& device, std::span<const Vec3f> x, int columns, int levels,
                              const Chunk& chunk) {
  if (x.empty()) return;
  const FieldConfig& config = field_.config();
  const MlpWeights weights(mlp_config(config), field_.params());
  const int n = int(x.size()), used = levels < 0 ? config.encoding.levels : levels;
  const int chunks = (n + kChunk - 1) / kChunk;
  state_->chunks.resize(chunks);
  parallel_for(chunks, [&](int c) {
    const int begin = c * kChunk, count = std::min(n, begin + kChunk) - begin;
    ChunkGradients& g = state_->chunks[c];
    g.reset(config, weights.gradient_size(), count, columns);
    points_to_panels(&x[begin], count, g.points.data());
    (columns == 1 ? state_->values : state_->jets).with([&](FieldPass& pass) {
      pass.forward(device, field_, weights, g.points.data(), g.padded, used, config.outputs);
      chunk(pass, begin, count);
      pass.backward(device, weights, g.padded, used, g.network.data(), g.d_encoding.data());
    });
  });
  accumulate_gradients(device, field_, state_->chunks, used, state_->optimizer);
}

void FieldTrainer::accumulate(const Device& device, std::span<const Vec3f> x, const Loss& loss, int levels) {
  const int outputs = field_.config().outputs;
  for_chunks(device, x, 1, levels, [&](FieldPass& pass, int begin, int count) {
    std::vector<float> y(size_t(count) * outputs), d_y(size_t(count) * outputs, 0.0f);
    for (int i = 0; i < count; ++i)
      for (int o = 0; o < outputs; ++o)
        y[size_t(i) * outputs + o] = pass.output()[panel_at(i, 1, 0, outputs, o)];
    loss(begin, begin + count, y.data(), d_y.data());
    for (int i = 0; i < padded_to_panels(count); ++i)
      for (int o = 0; o < outputs; ++o)
        pass.d_output()[panel_at(i, 1, 0, outputs, o)] = i < count ? d_y[size_t(i) * outputs + o] : 0.0f;
  });
}

void FieldTrainer::accumulate_jets(const Device& device, std::span<const Vec3f> x, const JetLoss& loss,
                                   int levels) {
  const int outputs = field_.config().outputs;
  for_chunks(device, x, kJetColumns, levels, [&](FieldPass& pass, int begin, int count) {
    const size_t size = size_t(padded_to_panels(count)) * kJetColumns * outputs;
    std::fill(pass.d_output(), pass.d_output() + size, 0.0f);
    const JetView jets{pass.output(), outputs};
    const JetGradView d_jets{pass.d_output(), outputs};
    for (int i = 0; i < count; ++i) {
      const FieldJet d = loss(begin + i, {jets.value(i), jets.gradient(i)});
      d_jets.add_value(i, d.value);
      d_jets.add_gradient(i, d.gradient);
    }
  });
}

void FieldTrainer::update(const Device& device, float rate) { state_->optimizer.step(device, rate); }

std::span<const float> FieldTrainer::gradient(const Param& param) const {
  return state_->optimizer.gradient(param);
}

void FieldTrainer::step(const Device& device, std::span<const Vec3f> x, const Loss& loss, float rate,
                        int levels) {
  accumulate(device, x, loss, levels);
  update(device, rate);
}

}  // namespace cei3d
