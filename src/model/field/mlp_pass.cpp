// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "core/base/error.h"
#include "core/compute/kernels/activate.h"
#include "core/compute/kernels/network_gradient.h"
#include "model/field/mlp.h"

namespace cei3d {

namespace {

constexpr float kHalfRoot = 0.70710678f;

template <template <class> class Kernel, class Args>
void launch_by_activation(const Device& device, Activation kind, const Args& a, int n) {
  switch (kind) {
    case Activation::relu:
      return device.launch<Kernel<Relu>>(a, n);
    case Activation::elu:
      return device.launch<Kernel<Elu>>(a, n);
    case Activation::softplus:
      return device.launch<Kernel<Softplus>>(a, n);
    case Activation::sigmoid:
      return device.launch<Kernel<Sigmoid>>(a, n);
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

// to[p][r] += from[p][first + r] for every panel p.
void add_rows(const float* from, int from_stride, int first, float* to, int to_stride, int rows, int panels) {
  for (int p = 0; p < panels; ++p) {
    const float* a = from + (size_t(p) * from_stride + first) * kPanel;
    float* b = to + size_t(p) * to_stride * kPanel;
    for (int k = 0; k < rows * kPanel; ++k) b[k] += a[k];
  }
}

// The same values for every sample: to[p][r][.] = values[r].
void spread_rows(const float* values, int rows, float* to, int to_stride, int panels) {
  for (int p = 0; p < panels; ++p)
    for (int r = 0; r < rows; ++r) std::fill_n(to + (size_t(p) * to_stride + r) * kPanel, kPanel, values[r]);
}

}  // namespace

MlpPass::MlpPass(const MlpConfig& config, int capacity, int columns)
    : config_(config), layers_(mlp_layers(config)), columns_(columns) {
  if (jets() && config.output_activation != Activation::none)
    fail("A network whose gradient is needed cannot have an output activation (an error in the program).");
  const size_t samples = size_t(capacity);
  x_.assign(samples * columns * config.inputs, 0.0f);
  y_.assign(samples * columns * config.outputs, 0.0f);
  d_y_ = y_;
  if (config.output_activation != Activation::none) y_raw_ = y_;
  size_t widest = config.inputs;
  for (size_t l = 0; l + 1 < layers_.size(); ++l) {
    const size_t own = samples * layers_[l].out, next = samples * layers_[l + 1].in;
    Hidden& hidden = hidden_.emplace_back();
    hidden.z.resize(own);
    hidden.h.resize(next);
    if (jets()) {
      hidden.d_h.resize(next);
      for (auto* rows : {&hidden.second, &hidden.d_z, &hidden.loss_by_z}) rows->resize(own);
    }
    widest = std::max(widest, size_t(std::max(layers_[l].in, layers_[l].out)));
  }
  widest = std::max(widest, size_t(layers_.back().in));
  d_a_.resize(samples * widest);
  d_b_.resize(samples * widest);
  if (config.skip_layer > 0) d_x_.resize(samples * config.inputs);
  if (!jets()) return;
  gradient_.assign(samples * config.inputs, 0.0f);
  loss_by_gradient_ = gradient_;
  ones_.assign(samples, 1.0f);
}

size_t MlpPass::offset(int layer) const {
  size_t floats = 0;
  for (int l = 0; l < layer; ++l) floats += size_t(layers_[l].out) * (layers_[l].in + 1);
  return floats;
}

// Turns the outputs of a layer, at h, into the input of the next one, where the network's input is appended.
void MlpPass::append_input(const float* x, int x_stride, float* h, int l, const Batch& s) const {
  const int out = layers_[l].out, stride = layers_[l + 1].in;
  copy_rows(h, stride, h, stride, 0, out, s.panels, kHalfRoot);
  copy_rows(x, x_stride, h, stride, out, config_.inputs, s.panels, kHalfRoot);
}

void MlpPass::activate(const Device& device, int l, const Batch& s) {
  const int out = layers_[l].out, stride = layers_[l + 1].in;
  Hidden& hidden = hidden_[l];
  const float beta = config_.softplus_beta;
  if (jets())
    launch_by_activation<ActivateTwice, ActivateTwiceArgs>(device, config_.activation,
                                                           {.z_first = hidden.z.data(),
                                                            .second = hidden.second.data(),
                                                            .y = hidden.h.data(),
                                                            .y_stride = stride,
                                                            .rows = out,
                                                            .beta = beta},
                                                           s.n);
  else
    launch_by_activation<Activate, ActivateArgs>(device, config_.activation,
                                                 {.z = hidden.z.data(),
                                                  .y = hidden.h.data(),
                                                  .z_stride = out,
                                                  .y_stride = stride,
                                                  .rows = out,
                                                  .beta = beta},
                                                 s.n);
  if (layers_[l + 1].concat) append_input(x_.data(), config_.inputs * columns_, hidden.h.data(), l, s);
}

void MlpPass::forward(const Device& device, const MlpWeights& w, int n, int active_inputs, int outputs) {
  const Batch s{n, n / kPanel, active_inputs};
  const float* x = x_.data();
  int stride = config_.inputs * columns_;
  for (int l = 0; l < last(); ++l) {
    device.linear({s.panels, in_use(s, l), layers_[l].out, x, stride, w.weight(l), layers_[l].in, w.bias(l),
                   hidden_[l].z.data(), layers_[l].out});
    activate(device, l, s);
    x = hidden_[l].h.data();
    stride = layers_[l + 1].in;
  }
  const int all = config_.outputs;
  float* y = y_raw_.empty() ? y_.data() : y_raw_.data();
  device.linear({s.panels, in_use(s, last()), outputs, x, stride, w.weight(last()), layers_[last()].in,
                 w.bias(last()), y, all * columns_});
  if (!y_raw_.empty())
    launch_by_activation<Activate, ActivateArgs>(
        device, config_.output_activation,
        {.z = y, .y = y_.data(), .z_stride = all, .y_stride = all, .rows = outputs, .beta = 1}, n);
  if (jets()) differentiate(device, w, s);
}

void MlpPass::differentiate(const Device& device, const MlpWeights& w, const Batch& s) {
  const int inputs = config_.inputs, top = last();
  float* d = top == 0 ? gradient_.data() : hidden_[top - 1].d_h.data();
  spread_rows(w.weight(top), in_use(s, top), d, layers_[top].in, s.panels);
  for (int l = top - 1; l >= 0; --l) {
    Hidden& hidden = hidden_[l];
    const int out = layers_[l].out, stride = layers_[l + 1].in;
    if (layers_[l + 1].concat)
      copy_rows(hidden.d_h.data(), stride, hidden.d_h.data(), stride, 0, stride, s.panels, kHalfRoot);
    device.launch<GradientStep>({.d_h = hidden.d_h.data(),
                                 .first = hidden.z.data(),
                                 .d_z = hidden.d_z.data(),
                                 .h_stride = stride,
                                 .rows = out},
                                s.n);
    d = l == 0 ? gradient_.data() : hidden_[l - 1].d_h.data();
    device.linear({s.panels, out, in_use(s, l), hidden.d_z.data(), out, w.transposed(l), out, nullptr, d,
                   layers_[l].in});
  }
  for (int l = 0; l < top; ++l)
    if (layers_[l + 1].concat)
      add_rows(hidden_[l].d_h.data(), layers_[l + 1].in, layers_[l].out, gradient_.data(), inputs,
               s.active_inputs, s.panels);
  device.launch<PointGradient>({.x = x_.data(),
                                .d_input = gradient_.data(),
                                .y = y_.data(),
                                .inputs = inputs,
                                .outputs = config_.outputs,
                                .rows = s.active_inputs},
                               s.n);
}

void MlpPass::differentiate_grad(const Device& device, const MlpWeights& w, const Batch& s, float* gradient,
                                 float* d_input) {
  const int inputs = config_.inputs;
  device.launch<PointGradientGrad>({.x = x_.data(),
                                    .d_input = gradient_.data(),
                                    .d_y = d_y_.data(),
                                    .t = loss_by_gradient_.data(),
                                    .d_x = d_input,
                                    .inputs = inputs,
                                    .outputs = config_.outputs,
                                    .rows = s.active_inputs},
                                   s.n);
  const float* t = loss_by_gradient_.data();
  int t_stride = inputs;
  float *next = d_a_.data(), *other = d_b_.data();
  for (int l = 0; l < last(); ++l) {
    Hidden& hidden = hidden_[l];
    const int in = in_use(s, l), out = layers_[l].out, stride = layers_[l + 1].in;
    device.linear_weight_grad({s.panels, in, out, t, t_stride, hidden.d_z.data(), out, gradient + offset(l),
                               layers_[l].in, nullptr});
    device.linear({s.panels, in, out, t, t_stride, w.weight(l), layers_[l].in, nullptr, next, stride});
    device.launch<GradientStepGrad>({.d_h = hidden.d_h.data(),
                                     .first = hidden.z.data(),
                                     .second = hidden.second.data(),
                                     .t = next,
                                     .d_z = hidden.loss_by_z.data(),
                                     .h_stride = stride,
                                     .rows = out},
                                    s.n);
    if (layers_[l + 1].concat) append_input(loss_by_gradient_.data(), inputs, next, l, s);
    t = next;
    t_stride = stride;
    std::swap(next, other);
  }
  device.linear_weight_grad({s.panels, in_use(s, last()), 1, t, t_stride, ones_.data(), 1,
                             gradient + offset(last()), layers_[last()].in, nullptr});
}

void MlpPass::activate_grad(const Device& device, int l, const Batch& s, float* d) {
  const int out = layers_[l].out, stride = layers_[l + 1].in, inputs = config_.inputs;
  const Hidden& hidden = hidden_[l];
  if (layers_[l + 1].concat) {
    copy_rows(d, stride, d, stride, 0, stride, s.panels, kHalfRoot);
    std::fill_n(d_x_.data(), size_t(s.panels) * inputs * kPanel, 0.0f);
    add_rows(d, stride, out, d_x_.data(), inputs, inputs, s.panels);
  }
  if (jets())
    device.launch<ActivateGradPlus>(
        {.first = hidden.z.data(), .d_z = hidden.loss_by_z.data(), .d = d, .d_stride = stride, .rows = out},
        s.n);
  else
    launch_by_activation<ActivateGrad, ActivateArgs>(device, config_.activation,
                                                     {.z = hidden.z.data(),
                                                      .y = d,
                                                      .z_stride = out,
                                                      .y_stride = stride,
                                                      .rows = out,
                                                      .beta = config_.softplus_beta},
                                                     s.n);
}

void MlpPass::backward(const Device& device, const MlpWeights& w, int n, int active_inputs, float* gradient,
                       float* d_input) {
  const Batch s{n, n / kPanel, active_inputs};
  const int all = config_.outputs, inputs = config_.inputs;
  if (jets()) differentiate_grad(device, w, s, gradient, d_input);
  if (!y_raw_.empty())
    launch_by_activation<ActivateGrad, ActivateArgs>(
        device, config_.output_activation,
        {.z = y_raw_.data(), .y = d_y_.data(), .z_stride = all, .y_stride = all, .rows = all, .beta = 1}, n);

  const float* d_y = d_y_.data();
  int d_stride = all * columns_;
  float *d_x = d_a_.data(), *other = d_b_.data();
  for (int l = last(); l >= 0; --l) {
    const MlpLayer& layer = layers_[l];
    const float* x = l == 0 ? x_.data() : hidden_[l - 1].h.data();
    const int in = in_use(s, l), x_stride = l == 0 ? inputs * columns_ : layer.in;
    float *gw = gradient + offset(l), *gb = gw + size_t(layer.out) * layer.in;
    device.linear_weight_grad({s.panels, in, layer.out, x, x_stride, d_y, d_stride, gw, layer.in, gb});
    if (l == 0 && !d_input) break;
    float* target = l == 0 ? d_input : d_x;
    device.linear(
        {s.panels, layer.out, in, d_y, d_stride, w.transposed(l), layer.out, nullptr, target, x_stride});
    if (l == 0) break;
    activate_grad(device, l - 1, s, target);
    d_y = target;
    d_stride = layer.in;
    std::swap(d_x, other);
  }
  if (d_input && config_.skip_layer > 0)
    add_rows(d_x_.data(), inputs, 0, d_input, inputs * columns_, inputs, s.panels);
}

}  // namespace cei3d
