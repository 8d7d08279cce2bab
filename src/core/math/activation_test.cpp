// SPDX-License-Identifier: Apache-2.0
// Hand-written derivatives of activations against dual numbers.
#include "core/math/activation.h"

#include <gtest/gtest.h>

#include "core/math/dual.h"

namespace cei3d {
namespace {

using D = Dual<double>;
using D2 = Dual<D>;

template <class A>
void check_activation(float beta) {
  for (double z : {-3.0, -0.4, -0.01, 0.02, 0.3, 2.5}) {
    const auto v = A::eval(z, beta);
    const auto d = A::eval(D2(D(z, 1.0), D(1.0, 0.0)), beta).value;
    EXPECT_NEAR(v.value, d.value.value, 1e-12);
    EXPECT_NEAR(v.first, d.derivative.value, 1e-9) << z;
    EXPECT_NEAR(v.second, d.derivative.derivative, 1e-6) << z;
  }
}

TEST(Activation, DerivativesEqualDualNumbers) {
  check_activation<Relu>(1);
  check_activation<Elu>(1);
  check_activation<Softplus>(1);
  check_activation<Softplus>(100);
  check_activation<Sigmoid>(1);
}

TEST(Activation, SoftplusNeitherOverflowsNorVanishes) {
  EXPECT_NEAR(Softplus::eval(50.0f, 100).value, 50.0f, 1e-5);
  EXPECT_GE(Softplus::eval(-50.0f, 100).value, 0.0f);
  EXPECT_NEAR(Sigmoid::eval(-200.0f, 1).value, 0.0f, 1e-30);
}

}  // namespace
}  // namespace cei3d
