// SPDX-License-Identifier: Apache-2.0
#include "model/field/mlp.h"

#include <cmath>
#include <string>

#include "core/math/rng.h"

namespace cei3d {

namespace {

std::string layer_name(size_t l, const char* what) { return "layer" + std::to_string(l) + "/" + what; }

}  // namespace

std::vector<MlpLayer> mlp_layers(const MlpConfig& c) {
  std::vector<MlpLayer> layers;
  int in = c.inputs;
  for (int l = 0; l < c.hidden_layers; ++l) {
    const bool concat = l > 0 && l == c.skip_layer;
    const bool before_skip = l + 1 == c.skip_layer && l + 1 < c.hidden_layers;
    const int out = before_skip ? c.width - c.inputs : c.width;  // so that the concatenation is `width` wide
    layers.push_back({concat ? in + c.inputs : in, out, concat});
    in = out;
  }
  layers.push_back({in, c.outputs, false});
  return layers;
}

void add_mlp_params(const MlpConfig& config, ParamSet& params, uint64_t seed) {
  const auto layers = mlp_layers(config);
  for (size_t l = 0; l < layers.size(); ++l) {
    Param& w = params.add(layer_name(l, "weight"), {layers[l].out, layers[l].in});
    const float bound = std::sqrt(2.0f / float(layers[l].in));
    for (size_t i = 0; i < w.count(); ++i) w.value[i] = bound * (2 * Rng(seed, l, i).uniform() - 1);
    params.add(layer_name(l, "bias"), {layers[l].out});
  }
}

MlpWeights::MlpWeights(const MlpConfig& config, const ParamSet& params)
    : config_(config), layers_(mlp_layers(config)) {
  for (size_t l = 0; l < layers_.size(); ++l) {
    const auto& w = params.get(layer_name(l, "weight")).value;
    const int in = layers_[l].in, out = layers_[l].out;
    std::vector<float> t(size_t(in) * out);
    for (int o = 0; o < out; ++o)
      for (int i = 0; i < in; ++i) t[size_t(i) * out + o] = w[size_t(o) * in + i];
    weights_.push_back(w);
    transposed_.push_back(std::move(t));
    biases_.push_back(params.get(layer_name(l, "bias")).value);
  }
}

size_t MlpWeights::gradient_size() const {
  size_t n = 0;
  for (const MlpLayer& l : layers_) n += size_t(l.out) * (l.in + 1);
  return n;
}

}  // namespace cei3d
