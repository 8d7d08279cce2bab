// SPDX-License-Identifier: Apache-2.0
#include "core/math/reflection_axis.h"

#include <gtest/gtest.h>

#include <array>
#include <utility>

#include "core/math/dual.h"
#include "core/math/reflection.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

using D = Dual<double>;

Vec3d viewer_at(double nv) { return {std::sqrt(1 - nv * nv), 0, nv}; }

// Brute force over the light directions of what reaches the viewer of uniform light, of the part of the
// reflectance that F0 scales, or of what it is without F0: calls visit(direction, weight).
template <class F>
void for_directions(ReflectionPart part, double nv, double roughness, const F& visit) {
  const int rows = 500, columns = 500;
  const Vec3d n{0, 0, 1}, v = viewer_at(nv);
  for (int i = 0; i < rows; ++i) {
    const double t = 0.5 * M_PI * (i + 0.5) / rows, s = std::sin(t), c = std::cos(t);
    for (int j = 0; j < columns; ++j) {
      const double a = 2 * M_PI * (j + 0.5) / columns;
      const Vec3d l{s * std::cos(a), s * std::sin(a), c};
      const double none = microfacet_brdf(n, v, l, 0.0, roughness),
                   all = microfacet_brdf(n, v, l, 1.0, roughness);
      visit(l, s * c * (part == ReflectionPart::base ? all - none : none));
    }
  }
}

Vec3d mean_direction(ReflectionPart part, double nv, double roughness) {
  Vec3d sum{0, 0, 0};
  double total = 0;
  for_directions(part, nv, roughness, [&](Vec3d l, double weight) {
    sum += l * weight;
    total += weight;
  });
  return sum / total;
}

// Length of the mean direction of the base part, and the mean squares along two axes.
std::pair<double, std::array<double, 2>> moments(double roughness, double nv, Vec3d x, Vec3d y) {
  double total = 0, xx = 0, yy = 0;
  for_directions(ReflectionPart::base, nv, roughness, [&](Vec3d l, double weight) {
    xx += weight * square(dot(l, x));
    yy += weight * square(dot(l, y));
    total += weight;
  });
  return {length(mean_direction(ReflectionPart::base, nv, roughness)), {xx / total, yy / total}};
}

// Mean direction of reflection_lobe() along the axis.
Vec3d mean_direction(const ReflectionAxis<double>& a) {
  const ReflectionLobe<double> lobe = reflection_lobe(a.roughness);
  double sum = 0;
  for (int j = 0; j < kReflectionLobes; ++j)
    sum += reflection_share(j) * (1 / std::tanh(lobe.lambda[j]) - 1 / lobe.lambda[j]);
  return a.axis * sum;
}

TEST(ReflectionAxis, LobesHaveTheMeanDirectionOfTheReflectedLight) {
  for (const double roughness : {0.2, 0.4, 0.6, 0.9})
    for (const double nv : {0.2, 0.5, 0.8}) {
      const auto gap = [&](ReflectionPart part) {
        const ReflectionAxis<double> a =
            reflection_axis(reflection_axis_table(part), Vec3d{0, 0, 1}, viewer_at(nv), roughness);
        return length(mean_direction(a) - mean_direction(part, nv, roughness));
      };
      EXPECT_LT(gap(ReflectionPart::base), 0.02) << roughness << ' ' << nv;
      if (nv < 0.8) {  // from there on it is a thousandth of the light
        EXPECT_LT(gap(ReflectionPart::fresnel), 0.04) << roughness << ' ' << nv;
      }
    }
}

TEST(ReflectionAxis, SmoothSurfacesMirror) {
  for (const double nv : {0.3, 0.9}) {
    const Vec3d n{0, 0, 1}, v = viewer_at(nv);
    const ReflectionAxis<double> a =
        reflection_axis(reflection_axis_table(ReflectionPart::base), n, v, double(kMinRoughness));
    EXPECT_GT(dot(a.axis, mirrored_direction(n, v)), 0.99999);
  }
}

// Brute force as above: standard deviations of the directions in the plane of incidence and across it.
TEST(ReflectionAxis, StretchIsTheRatioOfTheReflectionsWidths) {
  for (const double roughness : {0.3, 0.6})
    for (const double nv : {0.2, 0.5, 0.8}) {
      const Vec3d n{0, 0, 1}, v = viewer_at(nv);
      const LobeFrame<double> lobe = lobe_frame(reflection_tables().base, n, v, roughness);
      const Vec3d across = normalize(cross(n, v)), along = cross(across, lobe.axis);
      const auto [mean, squares] = moments(roughness, nv, along, across);
      EXPECT_NEAR(lobe.stretch, std::sqrt(squares[0] / squares[1]), 0.03) << roughness << ' ' << nv;
      EXPECT_GT(lobe.stretch, 1);
      // The widths of the lobe itself, in the plane: the sum of both variances is 2 (1 - length of the mean).
      const ReflectionLobe<double> round = reflection_lobe(lobe.roughness);
      double width = 0;
      for (int j = 0; j < kReflectionLobes; ++j)
        width += reflection_share(j) * (1 - 1 / std::tanh(round.lambda[j]) + 1 / round.lambda[j]);
      EXPECT_NEAR(width * (lobe.stretch + 1 / lobe.stretch) / 2, 1 - mean, 0.01) << roughness << ' ' << nv;
    }
}

TEST(ReflectionAxis, LobesSeenFromAboveAreRound) {
  const Vec3d n{0, 0, 1};
  for (const double roughness : {0.1, 0.3, 0.9}) {
    const LobeFrame<double> lobe = lobe_frame(reflection_tables().base, n, n, roughness);
    EXPECT_NEAR(lobe.stretch, 1, 0.01);
    EXPECT_EQ(length(lobe.across), 0);
  }
}

// A point's normal, viewer and material, each moved along one of eight directions.
struct Moved {
  Vec3<D> n, v;
  D roughness, specular, metalness;
};
constexpr int kMoves = 7;
Vec3<D> moved(Vec3d x, Vec3d along, double by) {
  return {D(x.x, along.x * by), D(x.y, along.y * by), D(x.z, along.z * by)};
}

void expect_adjoint(Vec3d n, Vec3d v, double roughness, double metalness) {
  const Vec3d tangent = normalize(cross(n, Vec3d{0.2, 0.5, 0.8})), other = cross(n, tangent);
  const Vec3d side = normalize(cross(v, Vec3d{0.7, 0.1, 0.3})), up = cross(v, side);
  const ReflectionTables tables = reflection_tables();
  const SurfaceReflection<double> d{
      {{0.3, -0.7, 0.5}, {0.8, 0.1, -0.4}, 0.4, -0.6}, {{-0.2, 0.6, 0.9}, {-0.5, 0.2, 0.3}, -0.8, 0.7}, 0.55};
  const SurfaceReflectionGrad<double> g = surface_reflection_grad(tables, n, v, roughness, 0.5, metalness, d);
  const double got[kMoves] = {dot(g.d_n, tangent), dot(g.d_n, other), dot(g.d_v, side), dot(g.d_v, up),
                              g.d_roughness,       g.d_specular,      g.d_metalness};
  for (int k = 0; k < kMoves; ++k) {
    const auto on = [&](int i) { return i == k ? 1.0 : 0.0; };
    const Vec3<D> dn = moved(n, tangent * on(0) + other * on(1), 1),
                  dv = moved(v, side * on(2) + up * on(3), 1);
    const SurfaceReflection<D> r =
        surface_reflection(tables, dn, dv, D(roughness, on(4)), D(0.5, on(5)), D(metalness, on(6)));
    const auto along = [](Vec3<D> x, Vec3d by) {
      return derivative_of(x.x) * by.x + derivative_of(x.y) * by.y + derivative_of(x.z) * by.z;
    };
    const auto of_lobe = [&](const LobeFrame<D>& lobe, const LobeFrame<double>& by) {
      return along(lobe.axis, by.axis) + along(lobe.across, by.across) +
             derivative_of(lobe.roughness) * by.roughness + derivative_of(lobe.stretch) * by.stretch;
    };
    const double want =
        of_lobe(r.base, d.base) + of_lobe(r.fresnel, d.fresnel) + derivative_of(r.share) * d.share;
    EXPECT_NEAR(got[k], want, 1e-8 * (1 + std::abs(want))) << "move " << k;
  }
}

// The split sum over both lobes is the reflectance times the mean radiance.
TEST(ReflectionAxis, ReflectionIsTheSameByGainsByPartsAndByTheMean) {
  const Vec3d base{2, 0.3, 0.9}, fresnel{0.1, 1.5, 0.4};
  for (const double metalness : {0.0, 1.0})
    for (const double nv : {0.1, 0.5, 0.95}) {
      const SplitSum<double> s = split_sum(split_sum_table(), nv, 0.4);
      const Vec3d albedo{kMetalF0, kMetalF0, kMetalF0}, f0 = f0_of(albedo, 0.5, metalness), white{1, 1, 1};
      const Vec3d want = mean_of_lobes(base_share(s, 0.5, metalness), base, fresnel) * reflectance(s, f0);
      EXPECT_NEAR(length(reflection_gains(s, f0).added_to(white, base, fresnel) - white - want), 0, 1e-12);
      const ReflectedParts<double> parts = reflected_parts(s, base, fresnel);
      EXPECT_NEAR(length(parts.sum(f0) - want), 0, 1e-12);
      EXPECT_NEAR(length(parts.removed_from(white, f0) + want - white), 0, 1e-12);
    }
}

TEST(ReflectionAxis, AdjointEqualsDualNumbersInEveryArgument) {
  for (uint64_t i = 0; i < 20; ++i) {
    Rng rng(5, 0, i);
    const auto direction = [&] { return normalize(Vec3d{rng.normal(), rng.normal(), rng.normal()}); };
    const Vec3d n = direction(), v = normalize(direction() + n * 1.3);
    expect_adjoint(n, v, 0.06 + 0.9 * double(rng.uniform()), i % 3 == 0 ? 0.0 : double(rng.uniform()));
  }
}

}  // namespace
}  // namespace cei3d
