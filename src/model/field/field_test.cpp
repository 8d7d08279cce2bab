// SPDX-License-Identifier: Apache-2.0
// Every device's field, forward and backward, values and jets, against a plain double-precision network whose
// derivatives are finite differences.
#include "model/field/field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/compute/kernels/panel.h"
#include "core/math/activation.h"
#include "core/math/rng.h"
#include "model/field/field_pass.h"
#include "model/field/gradients.h"

namespace cei3d {
namespace {

FieldConfig grid_config(Activation activation) {
  FieldConfig c;
  c.encoding = {0, 3, 4, 16, 7};
  c.hidden_layers = 2;
  c.width = 12;
  c.activation = activation;
  c.softplus_beta = 5;
  c.outputs = 4;
  c.sphere_radius = 0.5f;
  return c;
}

FieldConfig frequency_config() {
  FieldConfig c;
  c.encoding.frequencies = 2;
  c.hidden_layers = 4;
  c.width = 24;
  c.skip_layer = 2;
  c.activation = Activation::softplus;
  c.softplus_beta = 7;
  c.outputs = 2;
  return c;
}

// As the field of the geometry stage: one hidden layer.
FieldConfig shallow_config() {
  FieldConfig c = grid_config(Activation::softplus);
  c.hidden_layers = 1;
  c.outputs = 1;
  return c;
}

FieldConfig linear_config() {
  FieldConfig c = frequency_config();
  c.hidden_layers = 0;
  c.skip_layer = -1;
  return c;
}

// The field written down once more, in double, from the definition.
class Reference {
 public:
  explicit Reference(const Field& field) : config_(field.config()) {
    for (const Param& p : field.params().all()) params.push_back({p.value.begin(), p.value.end()});
  }
  std::vector<std::vector<double>> params;

  std::vector<double> eval(Vec3d p) const {
    const EncodingConfig& e = config_.encoding;
    std::vector<double> x{p.x, p.y, p.z};
    for (int k = 0; k < e.frequencies; ++k)
      for (int axis = 0; axis < 3; ++axis) {
        x.push_back(std::sin(std::pow(2, k) * p[axis]));
        x.push_back(std::cos(std::pow(2, k) * p[axis]));
      }
    for (int l = 0; l < e.levels; ++l) {
      const GridLevel g = grid_level(e, l);
      const GridCell<double> cell(g, p);
      double f[2] = {0, 0};
      for (int k = 0; k < 8; ++k)
        for (int j = 0; j < 2; ++j) f[j] += cell.weight(k) * params[l][2 * cell.corner(g, k) + j];
      x.insert(x.end(), f, f + 2);
    }
    const auto layers = mlp_layers(mlp_config(config_));
    std::vector<double> h = x;
    for (size_t l = 0; l < layers.size(); ++l) {
      const auto& w = params[e.levels + 2 * l];
      const auto& b = params[e.levels + 2 * l + 1];
      if (layers[l].concat) {
        h.insert(h.end(), x.begin(), x.end());
        for (double& v : h) v /= std::sqrt(2.0);
      }
      std::vector<double> y(layers[l].out);
      for (int o = 0; o < layers[l].out; ++o) {
        y[o] = b[o];
        for (int i = 0; i < layers[l].in; ++i) y[o] += w[size_t(o) * layers[l].in + i] * h[i];
        if (l + 1 < layers.size()) y[o] = activation(y[o]);
      }
      h = y;
    }
    if (config_.sphere_radius > 0) h[0] += length(p) - config_.sphere_radius;
    return h;
  }

  // All outputs, then the gradient of output 0.
  std::vector<double> eval_jet(Vec3d p) const {
    std::vector<double> out = eval(p);
    for (int axis = 0; axis < 3; ++axis) {
      Vec3d a = p, b = p;
      a[axis] += 1e-5;
      b[axis] -= 1e-5;
      out.push_back((eval(a)[0] - eval(b)[0]) / 2e-5);
    }
    return out;
  }

 private:
  double activation(double z) const {
    switch (config_.activation) {
      case Activation::relu:
        return Relu::eval(z, 1).value;
      case Activation::elu:
        return Elu::eval(z, 1).value;
      default:
        return Softplus::eval(z, config_.softplus_beta).value;
    }
  }
  FieldConfig config_;
};

// Points away from cell faces, where finite differences across a kink would lie.
std::vector<Vec3f> test_points(const FieldConfig& c, int n) {
  std::vector<Vec3f> points;
  for (uint64_t k = 0; int(points.size()) < n; ++k) {
    Rng rng(3, 0, k);
    Vec3f p{1.8f * rng.uniform() - 0.9f, 1.8f * rng.uniform() - 0.9f, 1.8f * rng.uniform() - 0.9f};
    bool clear = true;
    for (int l = 0; l < c.encoding.levels; ++l) {
      const GridCell<float> cell(grid_level(c.encoding, l), p);
      for (int a = 0; a < 3; ++a) clear = clear && cell.t[a] > 0.01f && cell.t[a] < 0.99f;
    }
    if (clear) points.push_back(p);
  }
  return points;
}

void randomize(Field& field) {
  for (Param& p : field.params().all())
    for (size_t i = 0; i < p.count(); ++i)
      if (p.name.starts_with("encoding")) p.value[i] = 0.3f * Rng(9, 1, i).normal();
}

class FieldOnDevice : public testing::TestWithParam<std::tuple<std::string, int>> {
 protected:
  static FieldConfig config(int kind) {
    const FieldConfig configs[] = {grid_config(Activation::softplus), grid_config(Activation::elu),
                                   frequency_config(), shallow_config(), linear_config()};
    return configs[kind];
  }
};

// Compares the optimizer's gradients with differences of a loss in double precision: the sum of every output
// and derivative of sample i, times c[i].
void expect_gradient(Field& field, Optimizer& optimizer, Reference& reference, const std::vector<Vec3f>& x,
                     const std::vector<std::vector<double>>& c) {
  const auto loss = [&] {
    double sum = 0;
    for (int i = 0; i < int(x.size()); ++i) {
      const std::vector<double> v = reference.eval_jet(to_double(x[i]));
      for (size_t k = 0; k < v.size(); ++k) sum += c[i][k] * v[k];
    }
    return sum;
  };
  for (size_t p = 0; p < reference.params.size(); ++p) {
    const Param& param = field.params().all()[p];
    const auto gradient = optimizer.gradient(param);
    double scale = 1e-3;
    for (size_t i = 0; i < param.count(); ++i) scale = std::max(scale, double(std::abs(gradient[i])));
    for (size_t i = 0; i < param.count(); i += 1 + param.count() / 12) {
      double& v = reference.params[p][i];
      const double keep = v, h = 1e-4;
      v = keep + h;
      const double up = loss();
      v = keep - h;
      const double down = loss();
      v = keep;
      EXPECT_NEAR(gradient[i], (up - down) / (2 * h), 2e-3 * scale) << param.name << " " << i;
    }
  }
}

TEST_P(FieldOnDevice, JetAndItsGradientEqualDoublePrecision) {
  const auto [name, kind] = GetParam();
  const Device device = make_device(name);
  Field field(config(kind), 1);
  randomize(field);
  const int n = 40, outputs = field.config().outputs, levels = field.config().encoding.levels;
  const std::vector<Vec3f> x = test_points(field.config(), n);
  ChunkGradients g;
  const MlpWeights weights(mlp_config(field.config()), field.params());
  g.reset(field.config(), weights.gradient_size(), n, 4);
  points_to_panels(x.data(), n, g.points.data());
  FieldPass pass(field.config(), 64, 4);
  pass.forward(device, field, weights, g.points.data(), g.padded, levels, outputs);

  // L = sum of every output and derivative times a fixed random number.
  Reference reference(field);
  std::vector<std::vector<double>> c(n);
  std::fill(pass.d_output(), pass.d_output() + size_t(g.padded) * 4 * outputs, 0.0f);
  for (int i = 0; i < n; ++i) {
    const std::vector<double> want = reference.eval_jet(to_double(x[i]));
    for (int k = 0; k < outputs + 3; ++k) {
      const size_t at =
          k < outputs ? panel_at(i, 4, 0, outputs, k) : panel_at(i, 4, k - outputs + 1, outputs, 0);
      EXPECT_NEAR(pass.output()[at], want[k], 2e-4 * (1 + std::abs(want[k])))
          << "sample " << i << " output " << k;
      c[i].push_back(Rng(5, i, k).normal());
      pass.d_output()[at] = float(c[i].back());
    }
  }
  Optimizer optimizer;
  optimizer.add(field.params(), "", {});
  pass.backward(device, weights, g.padded, levels, g.network.data(), g.d_encoding.data());
  accumulate_gradients(device, field, {g}, levels, optimizer);

  expect_gradient(field, optimizer, reference, x, c);
}

TEST_P(FieldOnDevice, AValueDoesNotDependOnItsNeighbors) {
  const auto [name, kind] = GetParam();
  const Device device = make_device(name);
  Field field(config(kind), 1);
  randomize(field);
  const int outputs = field.config().outputs;
  const std::vector<Vec3f> x = test_points(field.config(), 700);
  std::vector<float> all(x.size() * outputs), one(outputs);
  field.eval(device, x, all);
  for (size_t i : {0u, 31u, 32u, 511u, 699u}) {
    field.eval(device, std::span(&x[i], 1), one);
    for (int o = 0; o < outputs; ++o) EXPECT_EQ(one[o], all[i * outputs + o]);
  }
}

std::vector<std::string> device_names() {
  std::vector<std::string> names;
  for (const Device& d : all_devices()) names.push_back(d.name());
  return names;
}

INSTANTIATE_TEST_SUITE_P(All, FieldOnDevice,
                         testing::Combine(testing::ValuesIn(device_names()), testing::Range(0, 5)),
                         [](const auto& info) {
                           std::string name =
                               std::get<0>(info.param) + "_" + std::to_string(std::get<1>(info.param));
                           std::replace(name.begin(), name.end(), '/', '_');
                           return name;
                         });

TEST(FieldTrainer, LearnsASphereAndRepeatsBitForBit) {
  FieldConfig c = grid_config(Activation::softplus);
  c.sphere_radius = 0;
  c.outputs = 1;
  const Device device = make_device();
  const auto train = [&] {
    Field field(c, 4);
    FieldTrainer trainer(field, {});
    std::vector<Vec3f> x(1500);
    for (int step = 0; step < 200; ++step) {
      for (size_t i = 0; i < x.size(); ++i) {
        Rng rng(1, step, i);
        x[i] = {2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
      }
      trainer.step(device, x, [&](int begin, int end, const float* out, float* d) {
        for (int i = begin; i < end; ++i)
          d[i - begin] = 2 * (out[i - begin] - (length(x[i]) - 0.5f)) / float(x.size());
      });
    }
    std::vector<float> out(x.size());
    field.eval(device, x, out);
    double error = 0;
    for (size_t i = 0; i < x.size(); ++i) error += std::abs(out[i] - (length(x[i]) - 0.5f));
    EXPECT_LT(error / double(x.size()), 0.02);
    return out;
  };
  EXPECT_EQ(train(), train());
}

}  // namespace
}  // namespace cei3d
