// SPDX-License-Identifier: Apache-2.0
// The NeuS opacities against dual numbers and against the volume rendering integral through a plane.
#include "core/math/volume.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/math/dual.h"

namespace cei3d {
namespace {

using D = Dual<double>;

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
  // Along a straight ray through a plane at t = 0.5 the opacities accumulate to one, centered at the plane.
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

// 1 - exp(-integral of the density along a section of length delta), by Simpson's rule, where the distance in
// the middle is sdf and changes by `cosine` per unit of length. The density is max(0, -d Phi / dt) / Phi.
// [Wang et al. 2021 (NeuS), eq. 10]
double integrated_opacity(double sdf, double cosine, double delta, double inv_s) {
  constexpr int kIntervals = 400;
  const auto density = [&](double t) {
    const D phi = Sigmoid::eval(D(inv_s) * (D(sdf) + D(cosine) * (D(t, 1) - D(0.5 * delta))), 1).value;
    return std::max(0.0, -phi.derivative) / phi.value;
  };
  double sum = density(0) + density(delta);
  for (int i = 1; i < kIntervals; ++i) sum += (i % 2 ? 4 : 2) * density(delta * i / kIntervals);
  return 1 - std::exp(-sum * delta / kIntervals / 3);
}

NeusNeighbors<double> plane(double sdf, double cosine, double delta) {
  return {sdf - cosine * delta, sdf, sdf + cosine * delta, true, true};
}

struct PlaneCase {
  double sdf, cosine, delta, inv_s;
};
const PlaneCase kPlanes[] = {{0.004, -0.9, 0.01, 120},
                             {-0.006, -0.5, 0.02, 200},
                             {0.02, -1, 0.02, 100},
                             {0.0007, -0.2, 0.03, 300},
                             {0.003, 0.7, 0.01, 150}};

TEST(NeusAlpha, IsTheIntegralOfTheDensityThroughAPlane) {
  for (const PlaneCase& p : kPlanes) {
    const double want = integrated_opacity(p.sdf, p.cosine, p.delta, p.inv_s);
    // Phi is above 0.2 in all cases, so that the epsilon changes the ratio by 1e-5 / 0.2 at most.
    EXPECT_NEAR(neus_alpha<double>(p.sdf, p.cosine, p.delta, p.inv_s).alpha, want, 5e-5) << p.sdf;
    EXPECT_NEAR(neus_alpha_of_neighbors(plane(p.sdf, p.cosine, p.delta), p.delta, p.inv_s), want, 5e-5)
        << p.sdf;
  }
}

TEST(NeusAlphaOfNeighbors, OneNeighborIsEnoughForAPlane) {
  for (const PlaneCase& p : kPlanes) {
    const NeusNeighbors<double> both = plane(p.sdf, p.cosine, p.delta);
    NeusNeighbors<double> previous = both, next = both;
    previous.has_next = next.has_previous = false;
    previous.next = next.previous = 1e9;  // not read
    const double want = neus_alpha_of_neighbors(both, p.delta, p.inv_s);
    EXPECT_NEAR(neus_alpha_of_neighbors(previous, p.delta, p.inv_s), want, 1e-12);
    EXPECT_NEAR(neus_alpha_of_neighbors(next, p.delta, p.inv_s), want, 1e-12);
  }
}

TEST(NeusAlphaOfNeighbors, APointAloneIsTakenForASurfaceMetAt45Degrees) {
  const NeusNeighbors<double> alone{1e9, 0.002, 1e9, false, false};
  EXPECT_NEAR(neus_alpha_of_neighbors(alone, 0.01, 150.0), integrated_opacity(0.002, -0.7, 0.01, 150), 5e-5);
}

// Sections share their ends, so that what passes them all depends on the first and the last alone.
TEST(NeusAlphaOfNeighbors, SectionsAlongACurvedDescentLetThroughWhatTheirEndsSay) {
  const double delta = 0.01, inv_s = 90;
  std::vector<double> f;
  for (int i = 0; i < 12; ++i) f.push_back(0.03 - 0.004 * i - 0.0002 * i * i);
  double through = 1;
  for (size_t i = 1; i + 1 < f.size(); ++i)
    through *= 1 - neus_alpha_of_neighbors<double>({f[i - 1], f[i], f[i + 1], true, true}, delta, inv_s);
  const auto phi = [&](double a, double b) { return Sigmoid::eval(inv_s * (a + b) / 2, 1).value; };
  EXPECT_NEAR(through, phi(f[10], f[11]) / phi(f[0], f[1]), 5e-3 * through);
}

// The sampler's opacity and the renderer's are the same function of the plane, with the same derivatives.
TEST(NeusAlphaOfNeighbors, HasTheRenderersDerivativesOnAPlane) {
  for (const PlaneCase& p : kPlanes) {
    if (p.cosine > 0) continue;  // leaving: both are clamped to zero
    const auto alpha_of = [&](D sdf, D cosine) {
      const D step = cosine * D(p.delta);
      return neus_alpha_of_neighbors<D>({sdf - step, sdf, sdf + step, true, true}, D(p.delta), D(p.inv_s));
    };
    const NeusSample<double> v = neus_alpha<double>(p.sdf, p.cosine, p.delta, p.inv_s);
    EXPECT_NEAR(alpha_of(D(p.sdf, 1), D(p.cosine)).derivative, v.d_sdf, 1e-4 * std::abs(v.d_sdf) + 1e-3);
    EXPECT_NEAR(alpha_of(D(p.sdf), D(p.cosine, 1)).derivative, v.d_cosine,
                1e-4 * std::abs(v.d_cosine) + 1e-5);
  }
}

TEST(NeusAlpha, DeepInsideTheRendererIsOpaqueAndTheSamplerTransparent) {
  EXPECT_NEAR(neus_alpha<double>(-1, -1, 0.01, 400).alpha, 1, 1e-9);
  EXPECT_NEAR(neus_alpha_of_neighbors(plane(-1, -1, 0.01), 0.01, 400.0), 0, 1e-9);
}

}  // namespace
}  // namespace cei3d
