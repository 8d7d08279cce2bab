// SPDX-License-Identifier: Apache-2.0
// The specular term as one spherical Gaussian against quadrature of eq. 14, its adjoints against dual
// numbers.
#include "core/math/single_sg.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/dual.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

using D = Dual<double>;

Vec3d random_direction(Rng& rng) {
  return normalize(Vec3d{double(rng.normal()), double(rng.normal()), double(rng.normal())});
}

struct Sample {
  Vec3d n, v, axis;  // v: above the surface
  double lambda, sharpness, roughness, specular;
};
Sample sample(uint64_t i) {
  Rng rng(3, 0, i);
  Sample s{random_direction(rng),
           {},
           {},
           1 + 80 * double(rng.uniform()),
           5 + 150 * double(rng.uniform()),
           double(rng.uniform()),
           double(rng.uniform())};
  s.v = normalize(random_direction(rng) + s.n * 1.3);
  s.axis = normalize(s.n * (2 * dot(s.n, s.v)) - s.v + random_direction(rng) * 0.4);
  return s;
}

template <class T>
Vec3<T> as(Vec3d v) {
  return {T(v.x), T(v.y), T(v.z)};
}

// Specular radiance under one lobe of light of unit peak and at unit amplitude.
template <class T>
T radiance(Vec3<T> n, Vec3<T> v, T sharpness, T roughness, T specular, Vec3<T> axis, T lambda) {
  const MirrorLobe<T> lobe = mirror_lobe(n, v, sharpness);
  const Vec3<T> gap = lobe.axis - axis;
  return mirror_gain(lobe.nv, roughness, specular) *
         sg_mirrored(lambda, lobe.sharpness, dot(gap, gap), dot(n, axis), lobe.nv);
}

// The rendering integral of light and the lobe about the mirror direction, over the sphere, with Fresnel's
// and the shadowing term written out at the mirror direction. [paper eq. 2, 14]
double by_quadrature(const Sample& s) {
  const double nv = dot(s.n, s.v);
  const Vec3d r = s.n * (2 * nv) - s.v, h = normalize(r + s.v);
  const double ho = dot(h, s.v), k = (s.roughness + 1) * (s.roughness + 1) / 8,
               fresnel = s.specular + (1 - s.specular) * std::pow(2.0, (-5.55473 * ho - 6.98316) * ho),
               g = nv / (nv * (1 - k) + k), m = fresnel * g * g / (4 * nv * nv);
  constexpr int kRows = 1200, kColumns = 600;
  double sum = 0;
  for (int y = 0; y < kRows; ++y) {
    const double z = -1 + 2 * (y + 0.5) / kRows, flat = std::sqrt(1 - z * z);
    for (int x = 0; x < kColumns; ++x) {
      const double a = 2 * M_PI * (x + 0.5) / kColumns;
      const Vec3d i{flat * std::cos(a), flat * std::sin(a), z};
      sum += std::exp(s.lambda * (dot(i, s.axis) - 1)) * std::exp(s.sharpness / (4 * ho) * (dot(i, r) - 1)) *
             std::max(dot(i, s.n), 0.0);
    }
  }
  return m * sum * 4 * M_PI / (double(kRows) * kColumns);
}

TEST(SingleSg, IsTheRenderingIntegralOfItsLobe) {
  for (uint64_t i = 0; i < 12; ++i) {
    const Sample s = sample(i);
    const MirrorLobe<double> lobe = mirror_lobe(s.n, s.v, s.sharpness);
    const double max_radiance =  // with the light in the middle of the lobe, seen along the normal
        mirror_gain(lobe.nv, s.roughness, s.specular) * sg_mirrored(s.lambda, lobe.sharpness, 0.0, 1.0, 1.0);
    EXPECT_NEAR(radiance(s.n, s.v, s.sharpness, s.roughness, s.specular, s.axis, s.lambda), by_quadrature(s),
                0.015 * max_radiance)
        << i;
  }
}

// A lobe that is a distribution, in even light from everywhere, reflects what Fresnel's term says along the
// normal.
TEST(SingleSg, ReflectsItsSpecularAlbedoAlongTheNormal) {
  const Vec3d n{0, 0, 1};
  const double sharpness = 400, specular = 0.2, peak = sharpness / (2 * M_PI), lambda = 0.1;
  const double got = peak * radiance(n, n, sharpness, 0.3, specular, n, lambda);
  EXPECT_NEAR(got, specular, 0.02);  // a light of sharpness .1 is nearly even over the lobe
}

// The derivatives by the nth of n, sharpness, roughness, specular, axis and lambda.
D by_dual(const Sample& s, int varied) {
  Vec3<D> n = as<D>(s.n), axis = as<D>(s.axis);
  D sharpness(s.sharpness), roughness(s.roughness), specular(s.specular), lambda(s.lambda);
  D* all[] = {&n.x, &n.y, &n.z, &sharpness, &roughness, &specular, &axis.x, &axis.y, &axis.z, &lambda};
  all[varied]->derivative = 1;
  return radiance(n, as<D>(s.v), sharpness, roughness, specular, axis, lambda);
}

TEST(SingleSg, AdjointsAreTheDerivatives) {
  for (uint64_t i = 0; i < 40; ++i) {
    const Sample s = sample(100 + i);
    const MirrorLobe<double> lobe = mirror_lobe(s.n, s.v, s.sharpness);
    const Vec3d gap = lobe.axis - s.axis;
    const SgMirroredGrad<double> m =
        sg_mirrored_grad(s.lambda, lobe.sharpness, dot(gap, gap), dot(s.n, s.axis), lobe.nv);
    const MirrorGainGrad<double> gain = mirror_gain_grad(lobe.nv, s.roughness, s.specular);
    const MirrorLobe<double> d_lobe{gap * (2 * m.d_q * gain.value), m.d_nr * gain.value + m.value * gain.d_nv,
                                    m.d_sharpness * gain.value};
    const MirrorLobeGrad<double> d = mirror_lobe_grad(s.n, s.v, s.sharpness, d_lobe);
    const Vec3d d_n = d.d_normal + s.axis * (m.d_nl * gain.value),
                d_axis = (s.n * m.d_nl - gap * (2 * m.d_q)) * gain.value;
    const double got[] = {d_n.x,
                          d_n.y,
                          d_n.z,
                          d.d_sharpness,
                          m.value * gain.d_roughness,
                          m.value * gain.d_specular,
                          d_axis.x,
                          d_axis.y,
                          d_axis.z,
                          m.d_lambda * gain.value};
    for (int k = 0; k < 10; ++k) {
      const D want = by_dual(s, k);
      EXPECT_NEAR(m.value * gain.value, want.value, 1e-9 * std::abs(want.value) + 1e-12);
      EXPECT_NEAR(got[k], want.derivative, 1e-6 * std::abs(want.derivative) + 1e-9) << i << " by " << k;
    }
  }
}

TEST(SingleSg, IsFiniteAndHeldWhereTheViewIsFlat) {
  for (const double nv : {0.0, 0.02, -0.5}) {
    const Vec3d n{0, 0, 1}, v{std::sqrt(1 - nv * nv), 0, nv};
    const MirrorLobe<double> lobe = mirror_lobe(n, v, 110.0);
    EXPECT_EQ(lobe.sharpness, 110 / (4 * double(kMinMirrorCosine)));
    EXPECT_EQ(mirror_gain_grad(nv, 0.4, 0.2).d_nv, 0);
    EXPECT_TRUE(std::isfinite(radiance(n, v, 110.0, 0.4, 0.2, lobe.axis, 50.0)));
  }
}

}  // namespace
}  // namespace cei3d
