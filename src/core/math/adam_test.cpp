// SPDX-License-Identifier: Apache-2.0
#include "core/math/adam.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

constexpr float kRate = 0.1f, kBeta1 = 0.9f, kBeta2 = 0.99f, kEps = 1e-8f;

AdamStep step_at(int t) {
  return {float(kRate * bias_correction(kBeta1, kBeta2, t)), kBeta1, kBeta2, kEps, false};
}

// The corrected means of a constant gradient are the gradient and its square in every step.
TEST(Adam, MovesByTheRateUnderAConstantGradient) {
  for (const float gradient : {3.0f, -0.02f}) {
    float x = 1, m = 0, v = 0;
    for (int t = 1; t <= 50; ++t) {
      const float before = x;
      adam_update(step_at(t), gradient, x, m, v);
      EXPECT_NEAR(x - before, gradient > 0 ? -kRate : kRate, 1e-4f * kRate + 1e-6f) << t;
    }
  }
}

// Means without the recursion: weights of the gradient k steps ago are in proportion to beta^k.
TEST(Adam, WeighsGradientsByTheirAge) {
  const float gradients[] = {0.5f, -1.5f, 2, 0.25f};
  float x = 0, m = 0, v = 0, before = 0;
  for (int t = 1; t <= 4; ++t) {
    before = x;
    adam_update(step_at(t), gradients[t - 1], x, m, v);
  }
  double mean = 0, square = 0, weight1 = 0, weight2 = 0;
  for (int k = 0; k < 4; ++k) {
    const double w1 = std::pow(kBeta1, k), w2 = std::pow(kBeta2, k), g = gradients[3 - k];
    mean += w1 * g, weight1 += w1;
    square += w2 * g * g, weight2 += w2;
  }
  EXPECT_NEAR(x - before, -kRate * (mean / weight1) / std::sqrt(square / weight2), 1e-6f);
}

TEST(Adam, SkipsParametersWithoutGradient) {
  AdamStep step = step_at(1);
  step.skip_zero = true;
  float x = 1, m = 0.5f, v = 0.25f;
  adam_update(step, 0.0f, x, m, v);
  EXPECT_EQ(x, 1);
  EXPECT_EQ(m, 0.5f);
  EXPECT_EQ(v, 0.25f);
}

}  // namespace
}  // namespace cei3d
