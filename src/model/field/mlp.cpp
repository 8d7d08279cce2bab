// SPDX-License-Identifier: Apache-2.0
#include "model/field/mlp.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/compute/kernels/activate.h"
#include "core/math/rng.h"

namespace cei3d {

namespace {

constexpr float kHalfRoot = 0.70710678f;

std::string layer_name(size_t l, const char* what) { return "layer" + std::to_string(l) + "/" + what; }

void launch_activation(const Device& device, Activation kind, const ActivateArgs& a, int n) {
  switch (kind) {
    case Activation::relu:
      return device.launch<Activate<Relu>>(a, n);
    case Activation::elu:
      return device.launch<Activate<Elu>>(a, n);
    case Activation::softplus:
      return device.launch<Activate<Softplus>>(a, n);
    case Activation::sigmoid:
      return device.launch<Activate<Sigmoid>>(a, n);
    case Activation::none:
      break;
  }
}

void launch_activation_grad(const Device& device, Activation kind, const ActivateArgs& a, int n) {
  switch (kind) {
    case Activation::relu:
      return device.launch<ActivateGrad<Relu>>(a, n);
    case Activation::elu:
      return device.launch<ActivateGrad<Elu>>(a, n);
    case Activation::softplus:
      return device.launch<ActivateGrad<Softplus>>(a, n);
    case Activation::sigmoid:
      return device.launch<ActivateGrad<Sigmoid>>(a, n);
    case Activation::none:
      break;
  }
}

// to[p][first + r] = scale * from[p][r] for every panel p.
void copy_rows(const float* from, int from_stride, float* to, int to_stride, int first, int rows, int panels,
               float scale) {
  for (int p = 0; p < panels; ++p) {
    const float* a = from + size_t(p) * from_stride * kPanel;
    float* b = to + (size_t(p) * to_stride + first) * kPanel;
    for (int k = 0; k < rows * kPanel; ++k) b[k] = scale * a[k];
  }
}

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

MlpPass::MlpPass(const MlpConfig& config, int capacity, int columns)
    : config_(config), layers_(mlp_layers(config)), columns_(columns) {
  const size_t samples = size_t(capacity) * columns;
  x_.assign(samples * config.inputs, 0.0f);
  y_.assign(samples * config.outputs, 0.0f);
  d_y_ = y_;
  if (config.output_activation != Activation::none) y_raw_ = y_;
  size_t widest = config.inputs;
  for (size_t l = 0; l + 1 < layers_.size(); ++l) {
    z_.emplace_back(samples * layers_[l].out);
    h_.emplace_back(samples * layers_[l + 1].in);  // room for the appended input
    widest = std::max(widest, size_t(std::max(layers_[l].in, layers_[l].out)));
  }
  widest = std::max(widest, size_t(layers_.back().in));
  d_a_.resize(samples * widest);
  d_b_.resize(samples * widest);
  if (config.skip_layer > 0) d_x_.resize(x_.size());
}

void MlpPass::activate(const Device& device, int l, int n) {
  const int out = layers_[l].out, stride = layers_[l + 1].in;
  launch_activation(device, config_.activation,
                    {z_[l].data(), h_[l].data(), out, stride, out, columns_, config_.softplus_beta}, n);
  if (!layers_[l + 1].concat) return;
  copy_rows(h_[l].data(), stride, h_[l].data(), stride, 0, out, panels(n), kHalfRoot);
  copy_rows(x_.data(), config_.inputs, h_[l].data(), stride, out, config_.inputs, panels(n), kHalfRoot);
}

void MlpPass::forward(const Device& device, const MlpWeights& w, int n, int active_inputs, int outputs) {
  const int last = int(layers_.size()) - 1;
  const float* x = x_.data();
  for (int l = 0; l < last; ++l) {
    const MlpLayer& layer = layers_[l];
    device.linear({panels(n), l == 0 ? active_inputs : layer.in, layer.out, x, layer.in, w.weight(l),
                   layer.in, w.bias(l), columns_, z_[l].data(), layer.out});
    activate(device, l, n);
    x = h_[l].data();
  }
  const int in = last == 0 ? active_inputs : layers_[last].in, stride = layers_[last].in,
            all = config_.outputs;
  float* y = y_raw_.empty() ? y_.data() : y_raw_.data();
  // Output 0 in every column; the others in the value columns only.
  device.linear({panels(n), in, columns_ == 1 ? outputs : 1, x, stride, w.weight(last), stride, w.bias(last),
                 columns_, y, all});
  if (columns_ > 1 && outputs > 1)
    device.linear({n / kPanel, in, outputs - 1, x, stride * columns_, w.weight(last) + stride, stride,
                   w.bias(last) + 1, 1, y + kPanel, all * columns_});
  if (!y_raw_.empty())
    launch_activation(device, config_.output_activation, {y, y_.data(), all, all, outputs, columns_, 1}, n);
}

void MlpPass::activate_grad(const Device& device, int l, int n, float* d) {
  const int out = layers_[l].out, stride = layers_[l + 1].in;
  if (layers_[l + 1].concat) {
    float* dx = d_x_.data();
    for (int p = 0; p < panels(n); ++p) {
      float* dp = d + size_t(p) * stride * kPanel;
      for (int k = 0; k < out * kPanel; ++k) dp[k] *= kHalfRoot;
      for (int k = 0; k < config_.inputs * kPanel; ++k)
        dx[size_t(p) * config_.inputs * kPanel + k] = kHalfRoot * dp[out * kPanel + k];
    }
  }
  launch_activation_grad(device, config_.activation,
                         {z_[l].data(), d, out, stride, out, columns_, config_.softplus_beta}, n);
}

void MlpPass::backward(const Device& device, const MlpWeights& w, int n, int active_inputs, float* gradient,
                       float* d_input) {
  const int last = int(layers_.size()) - 1, all = config_.outputs;
  std::vector<size_t> offset(layers_.size(), 0);
  for (size_t l = 1; l < layers_.size(); ++l)
    offset[l] = offset[l - 1] + size_t(layers_[l - 1].out) * (layers_[l - 1].in + 1);
  if (!y_raw_.empty())
    launch_activation_grad(device, config_.output_activation,
                           {y_raw_.data(), d_y_.data(), all, all, all, columns_, 1}, n);

  const float* d_y = d_y_.data();
  int d_stride = all;
  float *d_x = d_a_.data(), *other = d_b_.data();
  for (int l = last; l >= 0; --l) {
    const MlpLayer& layer = layers_[l];
    const float* x = l == 0 ? x_.data() : h_[l - 1].data();
    const int in = l == 0 ? active_inputs : layer.in;
    float *gw = gradient + offset[l], *gb = gw + size_t(layer.out) * layer.in;
    const bool split = l == last && columns_ > 1;  // outputs after the first have no derivative columns
    device.linear_weight_grad(
        {panels(n), in, split ? 1 : layer.out, x, layer.in, d_y, d_stride, gw, layer.in, gb, columns_});
    if (split && all > 1)
      device.linear_weight_grad({n / kPanel, in, all - 1, x, layer.in * columns_, d_y + kPanel,
                                 all * columns_, gw + layer.in, layer.in, gb + 1, 1});
    if (l == 0 && !d_input) break;
    float* target = l == 0 ? d_input : d_x;
    device.linear({panels(n), split ? 1 : layer.out, in, d_y, d_stride, w.transposed(l), layer.out, nullptr,
                   1, target, layer.in});
    if (split && all > 1)
      device.linear({n / kPanel, all, in, d_y, all * columns_, w.transposed(l), layer.out, nullptr, 1, target,
                     layer.in * columns_});
    if (l == 0) break;
    activate_grad(device, l - 1, n, target);
    d_y = target;
    d_stride = layer.in;
    std::swap(d_x, other);
  }
  if (d_input && config_.skip_layer > 0)
    for (size_t k = 0; k < size_t(panels(n)) * config_.inputs * kPanel; ++k) d_input[k] += d_x_[k];
}

}  // namespace cei3d
