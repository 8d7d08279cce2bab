// SPDX-License-Identifier: Apache-2.0
#include "model/field/weight_norm.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/math/rng.h"

namespace cei3d {
namespace {

FieldConfig tiny() {
  FieldConfig c;
  c.width = 5;
  c.outputs = 1;
  c.activation = Activation::softplus;
  c.softplus_beta = 5;
  return c;
}
std::vector<Vec3f> points() {
  std::vector<Vec3f> x;
  for (uint64_t i = 0; i < 64; ++i) {
    Rng rng(1, 0, i);
    x.push_back({2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1});
  }
  return x;
}
float wanted(Vec3f p) { return 0.5f * p.x * p.x - p.y; }

void accumulate(const Device& device, FieldTrainer& trainer, const std::vector<Vec3f>& x) {
  trainer.accumulate(device, x, [&](int begin, int end, const float* out, float* d_out) {
    for (int i = begin; i < end; ++i)
      d_out[i - begin] = (out[i - begin] - wanted(x[size_t(i)])) / float(x.size());
  });
}
double loss(const Device& device, const Field& field, const std::vector<Vec3f>& x) {
  double sum = 0;
  const std::vector<float> got = first_output(device, field, x);
  for (size_t i = 0; i < x.size(); ++i)
    sum += 0.5 * std::pow(double(got[i] - wanted(x[i])), 2) / double(x.size());
  return sum;
}

constexpr float kStep = 1e-2f;  // of differences
using MovedRow = std::function<Vec3f(float)>;

// Slope of the loss, by differences, when one row of the first layer's weights moves.
double slope_of_row(const Device& device, const Field& field, const std::vector<Vec3f>& x, size_t row,
                    const MovedRow& moved) {
  double both[2];
  for (const int side : {0, 1}) {
    Field f = field;
    const Vec3f w = moved(side ? kStep : -kStep);
    for (int c = 0; c < 3; ++c) f.params().get("layer0/weight").value[3 * row + size_t(c)] = w[c];
    both[side] = loss(device, f, x);
  }
  return (both[1] - both[0]) / (2 * double(kStep));
}

// Adam's first step goes by the rate against the sign of every slope: of the length and the direction of each
// row, by differences of the loss.
TEST(WeightNorm, StepsAgainstTheSlopesOfLengthsAndDirections) {
  const Device device = make_device();
  const std::vector<Vec3f> x = points();
  constexpr float kRate = 1e-3f;
  Field field(tiny(), 2);
  const Field before = field;
  FieldTrainer trainer(field, {});
  WeightNorm norm(field, kRate, {.beta2 = 0.999f, .eps = 1e-12f});
  accumulate(device, trainer, x);
  norm.update(device, trainer, 1);
  const Param &was = before.params().get("layer0/weight"), &is = field.params().get("layer0/weight");
  for (size_t r = 0; r < 5; ++r) {
    const auto row = [&](const Param& p) {
      return Vec3f{p.value[3 * r], p.value[3 * r + 1], p.value[3 * r + 2]};
    };
    const auto slope = [&](const MovedRow& moved) { return slope_of_row(device, before, x, r, moved); };
    const Vec3f w = row(was);
    const float g = length(w);
    const double by_length = slope([&](float h) { return w * ((g + h) / g); });
    if (std::abs(by_length) > 1e-4) {
      EXPECT_NEAR(length(row(is)) - g, by_length > 0 ? -kRate : kRate, 0.02f * kRate) << r;
    }
    Vec3f v = w;  // the direction after the step
    for (int c = 0; c < 3; ++c) {
      const double by_v = slope([&](float h) {
        Vec3f u = w;
        u[c] += h;
        return u * (g / length(u));
      });
      v[c] -= by_v > 0 ? kRate : -kRate;
    }
    EXPECT_LT(length(normalize(row(is)) - normalize(v)), 0.1f * kRate / g) << r;
  }
}

TEST(WeightNorm, IsResumed) {
  const Device device = make_device();
  const std::vector<Vec3f> x = points();
  const auto run = [&](int until) {
    Field field(tiny(), 2);
    FieldTrainer trainer(field, {});
    auto norm = std::make_unique<WeightNorm>(field, 1e-2f, AdamConstants{});
    for (int step = 0; step < 20; ++step) {
      if (step == until) {
        Tensors saved;
        norm->save(saved, "n");
        norm = std::make_unique<WeightNorm>(field, 1e-2f, AdamConstants{});
        norm->load(saved, "n");
      }
      accumulate(device, trainer, x);
      norm->update(device, trainer, 1);
    }
    return field;
  };
  const Field whole = run(-1), resumed = run(9), start(tiny(), 2);
  for (size_t t = 0; t < whole.params().all().size(); ++t)
    EXPECT_EQ(whole.params().all()[t].value, resumed.params().all()[t].value);
  EXPECT_LT(loss(device, whole, x), 0.7 * loss(device, start, x));
}

}  // namespace
}  // namespace cei3d
