// SPDX-License-Identifier: Apache-2.0
// Hand-written gradients of activations, losses and the NeuS opacity against dual numbers.
#include "core/math/volume.h"

#include <gtest/gtest.h>

#include "core/math/dual.h"
#include "core/math/loss.h"

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

TEST(NeusAlpha, GradientEqualsDualNumbers) {
  for (double sdf : {-0.01, 0.001, 0.004, 0.02})
    for (double cosine : {-0.95, -0.3, 0.2, 0.9}) {
      const double delta = 0.01, s = 120;
      const auto v = neus_alpha<double>(sdf, cosine, delta, s);
      const auto by_sdf = neus_alpha<D>(D(sdf, 1), D(cosine), D(delta), D(s)).alpha.derivative;
      const auto by_cosine = neus_alpha<D>(D(sdf), D(cosine, 1), D(delta), D(s)).alpha.derivative;
      EXPECT_NEAR(v.d_sdf, by_sdf, 1e-9 * (1 + std::abs(by_sdf))) << sdf << " " << cosine;
      EXPECT_NEAR(v.d_cosine, by_cosine, 1e-9 * (1 + std::abs(by_cosine)));
    }
}

TEST(NeusAlpha, WeightsOfARayThroughASurfaceAddUpToOne) {
  // Along a straight ray through a plane at t = 0.5 the opacities accumulate to one, centred at the plane.
  const double delta = 0.002, s = 300;
  double transmittance = 1, mean = 0, sum = 0;
  for (double t = 0; t < 1; t += delta) {
    const double a = neus_alpha<double>(0.5 - (t + delta / 2), -1, delta, s).alpha;
    mean += transmittance * a * (t + delta / 2);
    sum += transmittance * a;
    transmittance *= 1 - a;
  }
  EXPECT_NEAR(sum, 1, 1e-3);
  EXPECT_NEAR(mean / sum, 0.5, 1e-3);
}

TEST(Loss, GradientsEqualDualNumbers) {
  for (double e : {-0.2, -0.01, 0.03, 0.4}) {
    EXPECT_NEAR(huber(e, 0.05).gradient, huber(D(e, 1), D(0.05)).value.derivative, 1e-12);
    const Vec3<double> g{0.3 + e, -0.8, 0.1};
    Vec3<double> d_g;
    eikonal(g, d_g);
    for (int k = 0; k < 3; ++k) {
      Vec3<D> gd{D(g.x), D(g.y), D(g.z)}, unused;
      gd[k].derivative = 1;
      EXPECT_NEAR(d_g[k], eikonal(gd, unused).derivative, 1e-9);
    }
  }
}

}  // namespace
}  // namespace cei3d
