// SPDX-License-Identifier: Apache-2.0
#include "core/math/sg.h"

#include <gtest/gtest.h>

#include "core/math/dual.h"

namespace cei3d {
namespace {

using D = Dual<double>;

// Quadrature over the sphere: midpoint in z and angle, axis 1 along z.
template <class F>
double over_sphere(F f) {
  const int rows = 3000, n = 100;
  double sum = 0;
  for (int i = 0; i < rows; ++i) {
    const double z = -1 + 2 * (i + 0.5) / rows, r = std::sqrt(1 - z * z);
    for (int j = 0; j < n; ++j) {
      const double a = 2 * M_PI * (j + 0.5) / n;
      sum += f(Vec3d{r * std::cos(a), r * std::sin(a), z});
    }
  }
  return sum * 4 * M_PI / (double(rows) * n);
}
Vec3d tilted(double angle) { return {std::sin(angle), 0, std::cos(angle)}; }
double lobe(Vec3d w, Vec3d axis, double lambda) { return std::exp(lambda * (dot(w, axis) - 1)); }

TEST(Sg, IntegralsOfLobesAndProductsMatchQuadrature) {
  for (const double l1 : {0.3, 4.0, 60.0})
    for (const double l2 : {0.8, 30.0})
      for (const double angle : {0.0, 0.4, 1.8, 3.0}) {
        const double q = 2 * (1 - std::cos(angle));
        const double truth = over_sphere([&](Vec3d w) {
          return lobe(w, {0, 0, 1}, l1) * lobe(w, tilted(angle), l2);
        });
        EXPECT_NEAR(sg_inner(l1, l2, q), truth, 1e-3 * truth + 1e-12) << l1 << ' ' << l2 << ' ' << angle;
      }
  EXPECT_NEAR(sg_integral(2.5), over_sphere([](Vec3d w) { return lobe(w, {0, 0, 1}, 2.5); }), 1e-4);
}

TEST(Sg, IrradianceIsWithinItsStatedError) {
  for (const double l : {0.5, 3.0, 20.0, 100.0}) {
    const double best = over_sphere([&](Vec3d w) { return lobe(w, {0, 0, 1}, l) * std::max(w.z, 0.0); });
    for (double angle = 0; angle < 2.7; angle += 0.3) {
      const Vec3d n = tilted(angle);
      const double truth = over_sphere([&](Vec3d w) {
        return lobe(w, {0, 0, 1}, l) * std::max(dot(w, n), 0.0);
      });
      EXPECT_NEAR(sg_irradiance(l, std::cos(angle)), truth, 0.013 * best) << l << ' ' << angle;
    }
  }
}

TEST(Sg, SharpLobesStayExactInSinglePrecision) {
  for (const double l2 : {800.0, 20000.0})
    for (const double angle : {0.0, 0.02, 0.2}) {
      const Vec3f a{0, 0, 1}, b = to_float(tilted(angle)), d = a - b;
      const double q = dot(to_double(b) - Vec3d{0, 0, 1}, to_double(b) - Vec3d{0, 0, 1});
      const double exact = sg_inner(150.0, l2, q);
      EXPECT_NEAR(sg_inner(150.0f, float(l2), dot(d, d)), exact, 1e-4 * exact);
    }
}

TEST(Sg, SlopesOfTheInnerProductMatchDualNumbers) {
  for (const double l1 : {0.7, 12.0, 300.0})
    for (const double l2 : {0.4, 45.0})
      for (const double q : {1e-4, 0.3, 2.0, 3.9}) {
        const auto s = sg_inner_grad(l1, l2, q);
        const double unit = s.value + 1e-300;
        EXPECT_NEAR(s.value / unit, sg_inner(l1, l2, q) / unit, 1e-12);
        EXPECT_NEAR(s.d_lambda1 / unit, derivative_of(sg_inner(D(l1, 1.0), D(l2), D(q))) / unit, 1e-9);
        EXPECT_NEAR(s.d_lambda2 / unit, derivative_of(sg_inner(D(l1), D(l2, 1.0), D(q))) / unit, 1e-9);
        EXPECT_NEAR(s.d_q / unit, derivative_of(sg_inner(D(l1), D(l2), D(q, 1.0))) / unit, 1e-9 * l1);
      }
}

TEST(Sg, SlopesOfHemisphereAndIrradianceMatchDualNumbers) {
  for (const double l : {0.2, 1.7, 25.0, 700.0})
    for (const double c : {-0.95, -0.2, 0.1, 0.999}) {
      const auto h = sg_hemisphere_grad(l, c);
      EXPECT_NEAR(h.value, sg_hemisphere(l, c), 1e-11);
      EXPECT_NEAR(h.d_lambda, derivative_of(sg_hemisphere(D(l, 1.0), D(c))), 1e-9);
      EXPECT_NEAR(h.d_cosine, derivative_of(sg_hemisphere(D(l), D(c, 1.0))), 1e-9);
      const auto e = sg_irradiance_grad(l, c);
      EXPECT_NEAR(e.value, sg_irradiance(l, c), 1e-10);
      EXPECT_NEAR(e.d_lambda, derivative_of(sg_irradiance(D(l, 1.0), D(c))), 1e-8);
      EXPECT_NEAR(e.d_cosine, derivative_of(sg_irradiance(D(l), D(c, 1.0))), 1e-8);
    }
}

}  // namespace
}  // namespace cei3d
