// SPDX-License-Identifier: Apache-2.0
#include "core/math/reflection_axis.h"

#include <gtest/gtest.h>

#include <utility>

#include "core/math/dual.h"
#include "core/math/reflection.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

using D = Dual<double>;

constexpr int kRows = 400, kColumns = 400;  // of directions

Vec3d viewer_at(double nv) { return {std::sqrt(1 - nv * nv), 0, nv}; }

// Brute force over the light directions of what reaches the viewer of uniform light, of the part of the
// reflectance that F0 scales, or of what it is without F0: calls visit(direction, weight).
template <class F>
void for_directions(ReflectionPart part, double nv, double roughness, const F& visit) {
  const Vec3d n{0, 0, 1}, v = viewer_at(nv);
  for (int i = 0; i < kRows; ++i) {
    const double t = 0.5 * M_PI * (i + 0.5) / kRows, s = std::sin(t), c = std::cos(t);
    for (int j = 0; j < kColumns; ++j) {
      const double a = 2 * M_PI * (j + 0.5) / kColumns;
      const Vec3d l{s * std::cos(a), s * std::sin(a), c};
      const double none = microfacet_brdf(n, v, l, 0.0, roughness),
                   all = microfacet_brdf(n, v, l, 1.0, roughness);
      visit(l, s * c * (part == ReflectionPart::base ? all - none : none));
    }
  }
}

// Density over directions of a stretched lobe.
class LobeDensity {
 public:
  explicit LobeDensity(const LobeFrame<double>& frame)
      : frame_(frame), lobe_(stretched_lobe(frame.roughness, frame.stretch)) {}
  double at(Vec3d l) const {
    const Vec3d gap = frame_.axis - l;
    const double across = square(dot(gap, frame_.across)), along = dot(gap, gap) - across;
    double sum = 0;
    for (int j = 0; j < kReflectionLobes; ++j)
      sum += lobe_.weight[j] * std::exp(-(lobe_.along[j] * along + lobe_.across[j] * across) / 2);
    return sum;
  }

 private:
  LobeFrame<double> frame_;
  StretchedLobe<double> lobe_;
};

// Half of the absolute difference of both densities above the horizon: 0 for equal ones, 1 for disjoint ones.
double distance_of(ReflectionPart part, double nv, double roughness, const LobeFrame<double>& frame) {
  const LobeDensity lobe(frame);
  double total = 0, difference = 0;
  const double cell = 0.5 * M_PI / kRows * 2 * M_PI / kColumns;
  for_directions(part, nv, roughness, [&](Vec3d, double weight) { total += weight; });
  for_directions(part, nv, roughness, [&](Vec3d l, double weight) {
    difference += std::abs(weight / total - lobe.at(l) * std::sqrt(1 - l.z * l.z) * cell);
  });
  return difference / 2;
}

struct Bound {
  double roughness, nv, base, fresnel;  // max distance
};

// Seen from above, Fresnel's part is a thousandth of the light.
TEST(ReflectionAxis, LobesAreNearTheReflectedLight) {
  constexpr double kAny = 2;
  constexpr Bound kBounds[] = {{0.2, 0.2, 0.12, 0.09},  {0.2, 0.4, 0.05, 0.05}, {0.2, 0.7, 0.025, 0.08},
                               {0.2, 1, 0.02, kAny},    {0.4, 0.2, 0.22, 0.14}, {0.4, 0.4, 0.13, 0.1},
                               {0.4, 0.7, 0.045, 0.13}, {0.4, 1, 0.025, kAny},  {0.7, 0.2, 0.18, 0.15},
                               {0.7, 0.4, 0.16, 0.14},  {0.7, 0.7, 0.1, 0.16},  {0.7, 1, 0.04, kAny}};
  for (const Bound& b : kBounds)
    for (const auto& [part, bound] :
         {std::pair{ReflectionPart::base, b.base}, std::pair{ReflectionPart::fresnel, b.fresnel}}) {
      const PartTables tables{reflection_axis_table(part), reflection_stretch_table(part)};
      const LobeFrame<double> lobe = lobe_frame(tables, Vec3d{0, 0, 1}, viewer_at(b.nv), b.roughness);
      EXPECT_LT(distance_of(part, b.nv, b.roughness, lobe), bound) << b.roughness << ' ' << b.nv;
    }
}

// A round lobe about the same axis is farther away.
TEST(ReflectionAxis, StretchingPaysAtGrazingAngles) {
  const Vec3d n{0, 0, 1};
  for (const double roughness : {0.2, 0.4})
    for (const double nv : {0.3, 0.6}) {
      const PartTables tables = reflection_tables().base;
      const LobeFrame<double> stretched = lobe_frame(tables, n, viewer_at(nv), roughness);
      const ReflectionAxis<double> axis = reflection_axis(tables.axis, n, viewer_at(nv), roughness);
      const LobeFrame<double> round{axis.axis, stretched.across, axis.roughness, 1};
      EXPECT_LT(distance_of(ReflectionPart::base, nv, roughness, stretched),
                0.6 * distance_of(ReflectionPart::base, nv, roughness, round));
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

void expect_adjoint(Vec3d n, Vec3d v, double roughness, double specular, double metalness) {
  const Vec3d tangent = normalize(cross(n, Vec3d{0.2, 0.5, 0.8})), other = cross(n, tangent);
  const Vec3d side = normalize(cross(v, Vec3d{0.7, 0.1, 0.3})), up = cross(v, side);
  const ReflectionTables tables = reflection_tables();
  const SurfaceReflection<double> d{
      {{0.3, -0.7, 0.5}, {0.8, 0.1, -0.4}, 0.4, -0.6}, {{-0.2, 0.6, 0.9}, {-0.5, 0.2, 0.3}, -0.8, 0.7}, 0.55};
  const SurfaceReflectionGrad<double> g =
      surface_reflection_grad(tables, n, v, roughness, specular, metalness, d);
  const double got[kMoves] = {dot(g.d_n, tangent), dot(g.d_n, other), dot(g.d_v, side), dot(g.d_v, up),
                              g.d_roughness,       g.d_specular,      g.d_metalness};
  for (int k = 0; k < kMoves; ++k) {
    const auto on = [&](int i) { return i == k ? 1.0 : 0.0; };
    const Vec3<D> dn = moved(n, tangent * on(0) + other * on(1), 1),
                  dv = moved(v, side * on(2) + up * on(3), 1);
    const SurfaceReflection<D> r =
        surface_reflection(tables, dn, dv, D(roughness, on(4)), D(specular, on(5)), D(metalness, on(6)));
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
      const Vec3d want =
          mean_of_lobes(base_share(s, 0.5, metalness), base, fresnel) * reflectance(s, f0, 1.0);
      EXPECT_NEAR(length(reflection_gains(s, f0, 1.0).added_to(white, base, fresnel) - white - want), 0,
                  1e-12);
      const ReflectedParts<double> parts = reflected_parts(s, base, fresnel);
      EXPECT_NEAR(length(parts.sum(f0) - want), 0, 1e-12);
      EXPECT_NEAR(length(parts.removed_from(white, f0) + want - white), 0, 1e-12);
    }
}

// Below the usual strength.
TEST(ReflectionAxis, TheStrengthScalesTheWholeReflectionOfADielectric) {
  const ReflectionTables tables = reflection_tables();
  const Vec3d n{0, 0, 1}, v = normalize(Vec3d{0.8, 0, 0.3}), black{0, 0, 0};
  const SplitSum<double> s = split_sum(split_sum_table(), dot(n, v), 0.4);
  const auto share = [&](double specular) {
    return surface_reflection(tables, n, v, 0.4, specular, 0.0).share;
  };
  const auto strength = [&](double specular) {
    return reflectance(s, f0_of(black, specular, 0.0), f90_of(specular, 0.0)).x;
  };
  EXPECT_NEAR(share(0.1), share(0.5), 1e-12);
  EXPECT_NEAR(strength(0.1), strength(0.5) / 5, 1e-12);
  EXPECT_NEAR(strength(1.0) - strength(0.5), 0.04 * s.scale, 1e-8);
}

TEST(ReflectionAxis, AdjointEqualsDualNumbersInEveryArgument) {
  for (uint64_t i = 0; i < 20; ++i) {
    Rng rng(5, 0, i);
    const auto direction = [&] { return normalize(Vec3d{rng.normal(), rng.normal(), rng.normal()}); };
    const Vec3d n = direction(), v = normalize(direction() + n * 1.3);
    expect_adjoint(n, v, 0.06 + 0.9 * double(rng.uniform()), i % 2 == 0 ? 0.5 : double(rng.uniform()),
                   i % 3 == 0 ? 0.0 : double(rng.uniform()));
  }
}

}  // namespace
}  // namespace cei3d
