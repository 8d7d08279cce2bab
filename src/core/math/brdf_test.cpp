// SPDX-License-Identifier: Apache-2.0
#include "core/math/brdf.h"

#include <gtest/gtest.h>

#include "core/math/dual.h"
#include "core/math/reflection.h"
#include "core/math/split_sum.h"

namespace cei3d {
namespace {

// Integral of f(l) over the hemisphere around +Z.
template <class F>
double over_hemisphere(F f) {
  const int rows = 700, columns = 700;
  double sum = 0;
  for (int i = 0; i < rows; ++i) {
    const double u = (i + 0.5) / rows, t = 0.5 * M_PI * u, s = std::sin(t);
    for (int j = 0; j < columns; ++j) {
      const double a = 2 * M_PI * (j + 0.5) / columns;
      sum += s * f(Vec3d{s * std::cos(a), s * std::sin(a), std::cos(t)});
    }
  }
  return sum * 0.5 * M_PI / rows * 2 * M_PI / columns;
}
constexpr Vec3d kUp{0, 0, 1};

TEST(Brdf, DensityOfFacetsIsNormalized) {
  for (const double roughness : {0.2, 0.5, 1.0})
    EXPECT_NEAR(over_hemisphere([&](Vec3d h) { return ggx_density(h.z, roughness * roughness) * h.z; }), 1,
                2e-3);
}

TEST(Brdf, IsReciprocal) {
  const Vec3d a = normalize(Vec3d{0.3, 0.5, 0.6}), b = normalize(Vec3d{-0.7, 0.2, 0.4});
  EXPECT_NEAR(microfacet_brdf(kUp, a, b, 0.04, 0.4), microfacet_brdf(kUp, b, a, 0.04, 0.4), 1e-14);
  EXPECT_EQ(microfacet_brdf(kUp, a, Vec3d{0, 0.8, -0.6}, 0.04, 0.4), 0);
}

TEST(SplitSum, SmoothWhiteMirrorLosesNothing) {
  const SplitSum<double> s = split_sum_integral(0.7, 0.05);
  EXPECT_NEAR(s.scale + s.bias, 1, 0.005);
}

TEST(Reflection, GaussiansHoldTheEnergyOfTheExactLobeRingByRing) {
  // Share of the reflected energy within an angle of the mirror direction, seen along the normal: exact lobe
  // (density of the half vector, masking of the light) against the mixture.
  for (const double roughness : {0.15, 0.3, 0.45, 0.7}) {
    const double alpha = roughness * roughness;
    const auto exact = [&](double t) {
      return ggx_density(std::cos(t / 2), alpha) * smith_g1(std::cos(t), alpha);
    };
    const ReflectionLobe<double> lobe = reflection_lobe(roughness);
    const auto mixture = [&](double t) {
      double sum = 0;
      for (int j = 0; j < kReflectionLobes; ++j)
        sum += lobe.weight[j] * std::exp(lobe.lambda[j] * (std::cos(t) - 1));
      return sum;
    };
    const auto within = [](auto f, double angle) {
      double sum = 0;
      for (int i = 0; i < 4000; ++i) {
        const double t = angle * (i + 0.5) / 4000;
        sum += 2 * M_PI * std::sin(t) * f(t) * angle / 4000;
      }
      return sum;
    };
    const double total = within(exact, M_PI / 2), total_mixture = within(mixture, M_PI / 2);
    for (const double x : {0.5, 1.0, 2.0, 4.0, 8.0}) {
      const double angle = std::min(2 * alpha * x, M_PI / 2);
      EXPECT_NEAR(within(mixture, angle) / total_mixture, within(exact, angle) / total,
                  roughness < 0.5 ? 0.05 : 0.1)
          << roughness << ' ' << x;
    }
    double all = 0;
    for (int j = 0; j < kReflectionLobes; ++j) all += double(reflection_share(j));
    EXPECT_NEAR(all, 1, 1e-6);
  }
}

// The angle is fitted; the energy within it is known.
TEST(Reflection, HalfOfTheEnergyIsWithinTheAngleThatItNames) {
  for (const double roughness : {0.1, 0.3, 0.5, 0.7}) {
    const ReflectionLobe<double> lobe = reflection_lobe(roughness);
    const double angle = 2 * std::atan(reflection_half_energy(roughness));
    double within = 0;
    for (int j = 0; j < kReflectionLobes; ++j)
      within += reflection_share(j) * (1 - std::exp(lobe.lambda[j] * (std::cos(angle) - 1))) /
                (1 - std::exp(-2 * lobe.lambda[j]));
    EXPECT_NEAR(within, 0.5, 0.01) << roughness;
  }
}

TEST(Brdf, DiffuseViewIsTheMeanOfBurleysTermOverUniformLight) {
  for (const double roughness : {0.1, 0.3, 0.6, 0.9})
    for (const double nv : {0.05, 0.2, 0.5, 0.8, 1.0}) {
      const Vec3d v{std::sqrt(1 - nv * nv), 0, nv};
      const double exact = over_hemisphere(
          [&](Vec3d l) { return burley_diffuse(l.z, nv, dot(l, normalize(v + l)), roughness) * l.z / M_PI; });
      EXPECT_NEAR(diffuse_view(nv, roughness), exact, 0.01 * exact) << roughness << ' ' << nv;
    }
}

// By Snell's law and the two polarizations.
double reflectance_of_glass(double cosine) {
  const double index = 1.5, below = std::sqrt(1 - (1 - cosine * cosine) / (index * index));
  const double s = (cosine - index * below) / (cosine + index * below),
               p = (index * cosine - below) / (index * cosine + below);
  return (s * s + p * p) / 2;
}

TEST(Brdf, FresnelsTermOfADielectricIsThatOfGlass) {
  for (double c = 0; c <= 1; c += 1.0 / 64) EXPECT_NEAR(fresnel(0.04, c), reflectance_of_glass(c), 1e-7) << c;
  EXPECT_NEAR(fresnel(0.7, 1.0), 0.7, 1e-7);
  EXPECT_NEAR(fresnel(0.7, 0.0), 1, 1e-7);
  using D = Dual<double>;
  const double d = derivative_of(fresnel(D(0.3), D(0.6, 1.0)));
  EXPECT_NEAR(d, (fresnel(0.3, 0.6 + 1e-5) - fresnel(0.3, 0.6 - 1e-5)) / 2e-5, 1e-6);
}

}  // namespace
}  // namespace cei3d
