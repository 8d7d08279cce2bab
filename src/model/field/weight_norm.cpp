// SPDX-License-Identifier: Apache-2.0
#include "model/field/weight_norm.h"

#include <algorithm>
#include <cmath>

namespace cei3d {
namespace {

double product(const float* a, const float* b, size_t n) {
  double sum = 0;
  for (size_t i = 0; i < n; ++i) sum += double(a[i]) * b[i];
  return sum;
}
double norm(const float* v, size_t n) { return std::sqrt(product(v, v, n)) + 1e-12; }

}  // namespace

WeightNorm::WeightNorm(Field& field, float rate, AdamConstants adam) {
  const size_t count = mlp_layers(mlp_config(field.config())).size();
  for (size_t l = 0; l < count; ++l) {
    const std::string name = "layer" + std::to_string(l);
    Param &weight = field.params().get(name + "/weight"), &bias = field.params().get(name + "/bias");
    const size_t first = own_.all().size();
    own_.add(name + "/direction", weight.shape).value = weight.value;
    Param& length = own_.add(name + "/length", {weight.shape[0]});
    for (size_t r = 0; r < length.count(); ++r)
      length.value[r] = float(norm(&weight.value[r * size_t(weight.shape[1])], size_t(weight.shape[1])));
    own_.add(name + "/bias", bias.shape).value = bias.value;
    layers_.push_back({&weight, &bias, first, first + 1, first + 2});
  }
  optimizer_.add(own_, "", {.rate = rate, .adam = adam});
  set_field();
}

// dL/dg = dL/dw . u and dL/dv = g / |v| (dL/dw - u (u . dL/dw)), with u = v / |v|.
void WeightNorm::update(const Device& device, FieldTrainer& trainer, float rate) {
  for (const Layer& l : layers_) {
    Param &v = own_.all()[l.direction], &g = own_.all()[l.length], &b = own_.all()[l.shift];
    const std::span<const float> by_weight = trainer.gradient(*l.weight), by_bias = trainer.gradient(*l.bias);
    const std::span<float> d_v = optimizer_.gradient(v), d_g = optimizer_.gradient(g),
                           d_b = optimizer_.gradient(b);
    const auto in = size_t(v.shape[1]);
    for (size_t r = 0; r < g.count(); ++r) {
      const float *row = &v.value[r * in], *d = &by_weight[r * in];
      const double length = norm(row, in), along = product(row, d, in) / length,
                   scale = double(g.value[r]) / length;
      d_g[r] += float(along);
      for (size_t i = 0; i < in; ++i)
        d_v[r * in + i] += float(scale * (double(d[i]) - along * double(row[i]) / length));
    }
    for (size_t i = 0; i < b.count(); ++i) d_b[i] += by_bias[i];
  }
  trainer.update(device, 0);
  optimizer_.step(device, rate);
  set_field();
}

void WeightNorm::set_field() {
  for (const Layer& l : layers_) {
    const Param &v = own_.all()[l.direction], &g = own_.all()[l.length];
    const auto in = size_t(v.shape[1]);
    for (size_t r = 0; r < g.count(); ++r) {
      const double scale = double(g.value[r]) / norm(&v.value[r * in], in);
      for (size_t i = 0; i < in; ++i)
        l.weight->value[r * in + i] = float(scale * double(v.value[r * in + i]));
    }
    l.bias->value = own_.all()[l.shift].value;
  }
}

void WeightNorm::save(Tensors& out, const std::string& prefix) const {
  own_.save(out, prefix);
  optimizer_.save(out, prefix + "_adam");
}
void WeightNorm::load(const Tensors& in, const std::string& prefix) {
  own_.load(in, prefix);
  optimizer_.load(in, prefix + "_adam");
  set_field();
}

}  // namespace cei3d
