// SPDX-License-Identifier: Apache-2.0
#include "core/math/shading.h"

#include <gtest/gtest.h>

#include <functional>

#include "core/math/dual.h"
#include "core/math/reflection.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

using D = Dual<double>;

// Every derivative is checked at these arguments, away from the kinks of clamps.
struct Sample {
  double nv, roughness;
};
constexpr Sample kSamples[] = {{0.03, 0.2}, {0.21, 0.07}, {0.5, 0.3}, {0.77, 0.62}, {0.94, 0.99}};

double along_nv(const std::function<D(D, D)>& f, Sample s) {
  return derivative_of(f(D(s.nv, 1.0), D(s.roughness)));
}
double along_roughness(const std::function<D(D, D)>& f, Sample s) {
  return derivative_of(f(D(s.nv), D(s.roughness, 1.0)));
}

TEST(SplitSum, IntegralIsThatOfTheBrdfOverTheHemisphere) {
  // Brute force over light directions, which the quadrature over facets knows nothing of.
  const auto truth = [](double nv, double roughness, double f0) {
    const int rows = 900, columns = 900;
    const Vec3d n{0, 0, 1}, v{std::sqrt(1 - nv * nv), 0, nv};
    double sum = 0;
    for (int i = 0; i < rows; ++i) {
      const double t = 0.5 * M_PI * (i + 0.5) / rows, s = std::sin(t), c = std::cos(t);
      for (int j = 0; j < columns; ++j) {
        const double a = M_PI * (j + 0.5) / columns;
        sum += s * c * microfacet_brdf(n, v, Vec3d{s * std::cos(a), s * std::sin(a), c}, f0, roughness);
      }
    }
    return sum * 0.5 * M_PI / rows * 2 * M_PI / columns;
  };
  for (const double roughness : {0.3, 0.6, 1.0})
    for (const double nv : {0.1, 0.4, 0.95})
      for (const double f0 : {0.0, 0.04, 1.0}) {
        const SplitSum<double> s = split_sum_integral(nv, roughness);
        EXPECT_NEAR(f0 * s.scale + s.bias, truth(nv, roughness, f0), 0.002)
            << roughness << ' ' << nv << ' ' << f0;
      }
}

TEST(SplitSum, TableFollowsTheIntegralBetweenItsNodes) {
  for (double roughness = 0.06; roughness < 1; roughness += 0.047)
    for (double nv = 0.05; nv < 1; nv += 0.031) {
      const SplitSum<double> want = split_sum_integral(nv, roughness),
                             got = split_sum(split_sum_table(), nv, roughness);
      const double tolerance = nv < 0.08 ? 0.012 : 0.0015;  // smooth surfaces change fast at grazing angles
      EXPECT_NEAR(got.scale, want.scale, tolerance) << nv << ' ' << roughness;
      EXPECT_NEAR(got.bias, want.bias, tolerance) << nv << ' ' << roughness;
      EXPECT_LE(got.scale + got.bias, 1.001);  // no more energy leaves than arrives
    }
}

TEST(SplitSum, SlopesAreTheDerivativesOfTheInterpolation) {
  for (const Sample s : kSamples) {
    const auto scale = [](D nv, D r) { return split_sum(split_sum_table(), nv, r).scale; };
    const auto bias = [](D nv, D r) { return split_sum(split_sum_table(), nv, r).bias; };
    const SplitSumGrad<double> g = split_sum_grad(split_sum_table(), s.nv, s.roughness);
    EXPECT_NEAR(g.d_nv.scale, along_nv(scale, s), 1e-9);
    EXPECT_NEAR(g.d_nv.bias, along_nv(bias, s), 1e-9);
    EXPECT_NEAR(g.d_roughness.scale, along_roughness(scale, s), 1e-9);
    EXPECT_NEAR(g.d_roughness.bias, along_roughness(bias, s), 1e-9);
  }
}

TEST(SplitSum, SlopesAreContinuousAcrossNodes) {
  const double cell = 1.0 / (kTableCosines - 1), node = 9 * cell;
  const auto slope = [](double nv) { return split_sum_grad(split_sum_table(), nv, 0.4).d_nv.scale; };
  EXPECT_NEAR(slope(node - 1e-9), slope(node + 1e-9), 1e-6);
  EXPECT_GT(std::abs(slope(node - cell) - slope(node + cell)), 1e-3);  // not because it is constant
}

TEST(SplitSum, OutOfRangeIsTheBorderAndFlat) {
  const SplitSumGrad<double> in = split_sum_grad(split_sum_table(), 1.0, double(kMinRoughness)),
                             out = split_sum_grad(split_sum_table(), 1.2, 0.01);
  EXPECT_EQ(in.value.scale, out.value.scale);
  EXPECT_EQ(out.d_nv.scale, 0);
  EXPECT_EQ(out.d_roughness.bias, 0);
}

TEST(Brdf, DiffuseViewSlopesEqualDualNumbers) {
  for (const Sample s : kSamples)
    for (const DiffuseLight<double> l :
         {DiffuseLight<double>{-0.6, 0.3, -0.25}, {0.1, 0.05, 0.01}, {0.9, 0, 0}}) {
      const DiffuseLight<D> light{D(l.lv), D(l.grazing), D(l.grazing_lv)};
      const DiffuseViewGrad<double> g = diffuse_view_grad(s.nv, s.roughness, l);
      EXPECT_NEAR(g.value, diffuse_view(s.nv, s.roughness, l), 1e-14);
      const auto f = [&](D nv, D r) { return diffuse_view(nv, r, light); };
      EXPECT_NEAR(g.d_nv, along_nv(f, s), 1e-12);
      EXPECT_NEAR(g.d_roughness, along_roughness(f, s), 1e-12);
      const auto along = [&](D DiffuseLight<D>::*member) {
        DiffuseLight<D> moved = light;
        moved.*member = D((light.*member).value, 1.0);
        return derivative_of(diffuse_view(D(s.nv), D(s.roughness), moved));
      };
      EXPECT_NEAR(g.d_light.lv, along(&DiffuseLight<D>::lv), 1e-12);
      EXPECT_NEAR(g.d_light.grazing, along(&DiffuseLight<D>::grazing), 1e-12);
      EXPECT_NEAR(g.d_light.grazing_lv, along(&DiffuseLight<D>::grazing_lv), 1e-12);
    }
}

TEST(Brdf, EvenLightSlopeEqualsDualNumbers) {
  const DiffuseLight<double> d{0.3, -0.7, 0.9};
  const DiffuseLight<D> light = even_light(D(0.4, 1.0));
  EXPECT_NEAR(even_light_grad(d),
              d.lv * derivative_of(light.lv) + d.grazing * derivative_of(light.grazing) +
                  d.grazing_lv * derivative_of(light.grazing_lv),
              1e-12);
}

// All numbers of a point, to differentiate by one of them.
constexpr int kMembers = 16;
template <class T>
ShadingPoint<T> point_of(const T (&x)[kMembers]) {
  return {{x[0], x[1], x[2]},   x[3], x[4], x[5], x[6], {x[7], x[8], x[9]}, {x[10], x[11], x[12]},
          {x[13], x[14], x[15]}};
}
void members_of(const ShadingPoint<double>& p, double (&x)[kMembers]) {
  const double all[kMembers] = {p.albedo.x,
                                p.albedo.y,
                                p.albedo.z,
                                p.roughness,
                                p.specular,
                                p.metalness,
                                p.nv,
                                p.irradiance.x,
                                p.irradiance.y,
                                p.irradiance.z,
                                p.reflected.x,
                                p.reflected.y,
                                p.reflected.z,
                                p.diffuse_light.lv,
                                p.diffuse_light.grazing,
                                p.diffuse_light.grazing_lv};
  std::copy(all, all + kMembers, x);
}

void expect_grad_equals_duals(const double (&x)[kMembers]) {
  const Vec3d d_diffuse{0.3, -0.8, 0.5}, d_specular{-0.4, 0.9, 0.2};
  double got[kMembers];
  members_of(shading_grad(split_sum_table(), point_of(x), d_diffuse, d_specular), got);
  for (int k = 0; k < kMembers; ++k) {
    D y[kMembers];
    for (int i = 0; i < kMembers; ++i) y[i] = D(x[i], i == k ? 1.0 : 0.0);
    const ShadingPoint<D> p = point_of(y);
    const ShadingTerms<D> t = shading_terms(split_sum_table(), p);
    const Vec3<D> diffuse = t.diffuse(p.albedo), specular = t.specular(p.albedo);
    double want = 0;
    for (int c = 0; c < 3; ++c)
      want += d_diffuse[c] * derivative_of(diffuse[c]) + d_specular[c] * derivative_of(specular[c]);
    EXPECT_NEAR(got[k], want, 1e-9 * (1 + std::abs(want))) << "member " << k;
  }
}

TEST(Shading, AdjointEqualsDualNumbersInEveryArgument) {
  for (uint64_t i = 0; i < 40; ++i) {
    double x[kMembers];
    for (int k = 0; k < kMembers; ++k) x[k] = 0.06 + 0.9 * double(Rng(11, i, uint64_t(k)).uniform());
    expect_grad_equals_duals(x);
  }
  expect_grad_equals_duals(
      {0.2, 0.5, 0.8, 0.02, 0.5, 0, 0.6, 1, 2, 3, 2, 1, 1, 0.4, 0.05, 0.01});  // smoother than the table
  expect_grad_equals_duals(
      {0.2, 0.5, 0.8, 0.4, 0.5, 1, -0.05, 1, 2, 3, 2, 1, 1, 0.2, 0.1, 0.02});  // seen from behind
}

TEST(Shading, IncidentLightAdjointEqualsDualNumbers) {
  const Vec3d d_irradiance{0.3, -0.8, 0.5}, d_reflected{-0.4, 0.9, 0.2};
  const auto light_of = [](auto&& x) {
    return IncidentLight<std::decay_t<decltype(x(0))>>{{x(0), x(1), x(2)},    {x(3), x(4), x(5)},
                                                       {x(6), x(7), x(8)},    {x(9), x(10), x(11)},
                                                       {x(12), x(13), x(14)}, {x(15), x(16), x(17)}};
  };
  const auto value = [](int k) { return 0.1 + 0.9 * double(Rng(12, 0, uint64_t(k)).uniform()); };
  const IncidentLight<double> g = incident_light_grad(light_of(value), d_irradiance, d_reflected);
  std::vector<double> got;
  for (const Vec3d& v :
       {g.sky_irradiance, g.visibility, g.bounce, g.sky_reflection, g.mirror_visibility, g.object_reflection})
    got.insert(got.end(), {v.x, v.y, v.z});
  for (int k = 0; k < 18; ++k) {
    const auto light = light_of([&](int i) { return D(value(i), i == k ? 1.0 : 0.0); });
    double want = 0;
    for (int c = 0; c < 3; ++c)
      want += d_irradiance[c] * derivative_of(light.irradiance()[c]) +
              d_reflected[c] * derivative_of(light.reflected()[c]);
    EXPECT_NEAR(got[k], want, 1e-12) << k;
  }
}

TEST(Shading, AdjointOfTheMirroredDirectionEqualsDualNumbersAlongTheSphere) {
  const Vec3d n = normalize(Vec3d{0.2, 0.3, 0.9}), v = normalize(Vec3d{-0.5, 0.4, 0.6}),
              d_mirror{0.7, -0.2, 0.4};
  Vec3d d_n{0, 0, 0}, d_v{0, 0, 0};
  mirrored_direction_grad(n, v, d_mirror, d_n, d_v);
  const auto dual = [](Vec3d x, Vec3d dx) { return Vec3<D>{D(x.x, dx.x), D(x.y, dx.y), D(x.z, dx.z)}; };
  const auto slope = [&](Vec3<D> m) {
    return d_mirror.x * derivative_of(m.x) + d_mirror.y * derivative_of(m.y) +
           d_mirror.z * derivative_of(m.z);
  };
  for (const Vec3d t : {Vec3d{0.3, 0.5, 0.8}, Vec3d{-0.9, 0.1, 0.2}}) {
    const Vec3d at_n = cross(n, t), at_v = cross(v, t), still{0, 0, 0};
    EXPECT_NEAR(dot(d_n, at_n), slope(mirrored_direction(dual(n, at_n), dual(v, still))), 1e-12);
    EXPECT_NEAR(dot(d_v, at_v), slope(mirrored_direction(dual(n, still), dual(v, at_v))), 1e-12);
  }
  EXPECT_NEAR(dot(d_n, n), 0, 1e-12);
  EXPECT_NEAR(dot(d_v, v), 0, 1e-12);
}

TEST(Reflection, LobeOfAnyRoughnessHoldsTheSpheresEnergyOnce) {
  for (const double roughness : {0.05, 0.2, 0.5, 0.9}) {
    const ReflectionLobe<double> lobe = reflection_lobe(roughness);
    double total = 0;  // of every Gaussian: the integral over the sphere
    for (int j = 0; j < kReflectionLobes; ++j)
      total += lobe.weight[j] * 2 * M_PI * (1 - std::exp(-2 * lobe.lambda[j])) / lobe.lambda[j];
    EXPECT_NEAR(total, 1, 1e-6) << roughness;
  }
}

void expect_reflected_grad(double lambda, double roughness, double stretch, double q, double h) {
  const auto value = [](D l, D r, D s, D q_, D h_) { return sg_reflected(l, stretched_lobe(r, s), q_, h_); };
  const StretchedLobe<double> lobe = stretched_lobe(roughness, stretch);
  const SgReflectedGrad<double> light = sg_reflected_grad(lambda, lobe, q, h);
  StretchedLobe<double> d_lobe{};
  const SgDistanceGrad<double> distance = sg_reflected_lobe_grad(lambda, lobe, q, h, 0.7, d_lobe);
  const LobeMaterialGrad<double> material = stretched_lobe_grad(roughness, stretch, d_lobe);
  const D l(lambda), r(roughness), s(stretch), d(q), e(h);
  EXPECT_NEAR(light.value, value_of(value(l, r, s, d, e)), 1e-12);
  const auto near = [](double got, D wanted, double times = 1) {
    const double want = derivative_of(wanted) * times;
    EXPECT_NEAR(got, want, 1e-9 * (1 + std::abs(want)));
  };
  near(light.d_lambda, value(D(lambda, 1.0), r, s, d, e));
  near(light.d_q, value(l, r, s, D(q, 1.0), e));
  near(light.d_h, value(l, r, s, d, D(h, 1.0)));
  near(distance.d_q, value(l, r, s, D(q, 1.0), e), 0.7);
  near(distance.d_h, value(l, r, s, d, D(h, 1.0)), 0.7);
  near(material.d_roughness, value(l, D(roughness, 1.0), s, d, e), 0.7);
  near(material.d_stretch, value(l, r, D(stretch, 1.0), d, e), 0.7);
}

TEST(Reflection, SlopesByLobeLightAndDistanceEqualDualNumbers) {
  for (const double roughness : {0.07, 0.3, 0.65, 0.95})
    for (const double stretch : {1.0, 1.3, 3.0})
      for (const double lambda : {0.8, 12.0, 300.0})
        for (const double q : {0.001, 0.2, 1.5})
          for (const double share : {0.0, 0.4})
            expect_reflected_grad(lambda, roughness, stretch, q, share * q);
  StretchedLobe<double> d_lobe{};
  sg_reflected_lobe_grad(2.0, stretched_lobe(0.01, 1.0), 0.1, 0.0, 1.0, d_lobe);
  EXPECT_EQ(stretched_lobe_grad(0.01, 1.0, d_lobe).d_roughness, 0);
}

TEST(Reflection, StretchedLobeOfStretchOneIsTheRoundOne) {
  for (const double lambda : {0.8, 12.0, 300.0})
    for (const double q : {0.001, 0.2, 1.5}) {
      const ReflectionLobe<double> round = reflection_lobe(0.4);
      double want = 0;
      for (int j = 0; j < kReflectionLobes; ++j)
        want += round.weight[j] * sg_inner(lambda, round.lambda[j], q);
      EXPECT_NEAR(sg_reflected(lambda, stretched_lobe(0.4, 1.0), q, 0.3 * q), want, 1e-12 * (1 + want));
    }
}

// Brute force over directions of the product of a light lobe and a lobe whose logarithm is quadratic in the
// distances along and across, which the closed form approximates for sharp lobes.
TEST(Reflection, StretchedLobeIntegratesAGaussianOfTwoWidths) {
  const double lambda = 60, along = 40, across = 160;
  const Vec3d axis{0, 0, 1}, side{0, 1, 0};
  for (const Vec3d light : {Vec3d{0.2, 0.0, 1.0}, Vec3d{0.0, 0.2, 1.0}, Vec3d{-0.15, 0.1, 1.0}}) {
    const Vec3d l = normalize(light);
    double sum = 0;
    constexpr int kSteps = 600;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const double x = -1 + 2 * (i + 0.5) / kSteps, y = -1 + 2 * (j + 0.5) / kSteps, zz = 1 - x * x - y * y;
        if (zz <= 0) continue;
        const Vec3d w{x, y, std::sqrt(zz)};
        const double q = dot(w - axis, w - axis), h = square(dot(w, side));
        sum += std::exp(lambda * (dot(w, l) - 1) - 0.5 * (along * (q - h) + across * h)) / w.z;
      }
    sum *= square(2.0 / kSteps);
    const Vec3d gap = l - axis;
    const double got = sg_stretched_inner(lambda, along, across, dot(gap, gap), square(dot(gap, side)));
    EXPECT_NEAR(got, sum, 0.03 * sum);
  }
}

}  // namespace
}  // namespace cei3d
