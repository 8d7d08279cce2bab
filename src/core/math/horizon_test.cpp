// SPDX-License-Identifier: Apache-2.0
#include "core/math/horizon.h"

#include <gtest/gtest.h>

#include "core/math/dual.h"
#include "core/math/facets.h"
#include "core/math/fibonacci.h"
#include "core/math/reflection_axis.h"

namespace cei3d {
namespace {

using D = Dual<double>;

TEST(Horizon, SlopesEqualDualNumbers) {
  for (const double cosine : {-0.6, 0.1, 0.8})
    for (const double height : {0.1, 0.7}) {
      const double lambda = 20, sharpness = 12;
      const auto value = [](D l, D c, D s, D h) {
        return Horizon<D>{s, h, logistic(D(-kLogisticScale) * h * sqrt(s))}.share(l, c);
      };
      const auto on = [&](int varied) {
        const auto x = [&](double at, int k) { return D(at, k == varied ? 1.0 : 0.0); };
        return derivative_of(value(x(lambda, 0), x(cosine, 1), x(sharpness, 2), x(height, 3)));
      };
      const Horizon<double> horizon{sharpness, height,
                                    logistic(-double(kLogisticScale) * height * std::sqrt(sharpness))};
      const HorizonShareGrad<double> g = horizon.share_grad(lambda, cosine);
      EXPECT_NEAR(g.value, horizon.share(lambda, cosine), 1e-12);
      const double got[] = {g.d_lambda, g.d_cosine, g.d_sharpness, g.d_height};
      for (int k = 0; k < 4; ++k) EXPECT_NEAR(got[k], on(k), 1e-10) << k;
    }
}

TEST(Horizon, SlopesByTheLobeEqualDualNumbers) {
  const double roughness = 0.45, height = 0.3, lambda = 9, cosine = 0.2;
  StretchedLobe<double> lobe = stretched_lobe(roughness, 1.6), d_lobe{};
  const HorizonShareGrad<double> g = horizon_of(lobe, height).share_grad(lambda, cosine);
  EXPECT_EQ(horizon_grad(-0.1, 0.0, 1.0, d_lobe), 0);
  const double d_height = horizon_grad(height, g.d_sharpness, g.d_height, d_lobe);
  const auto value = [&](D r, D h) {
    return horizon_of(stretched_lobe(r, D(1.6)), h).share(D(lambda), D(cosine));
  };
  EXPECT_NEAR(d_height, derivative_of(value(D(roughness), D(height, 1.0))), 1e-10);
  EXPECT_NEAR(stretched_lobe_grad(roughness, 1.6, d_lobe).d_roughness,
              derivative_of(value(D(roughness, 1.0), D(height))), 1e-10);
}

TEST(Horizon, AnEvenLightIsReflectedWholeAndALampBehindTheSurfaceNotAtAll) {
  for (const float height : {0.1f, 0.5f, 1.0f}) {
    const Horizon<float> smooth = horizon_of(stretched_lobe(0.2f, 1.3f), height),
                         rough = horizon_of(stretched_lobe(0.6f, 1.3f), height);
    EXPECT_NEAR(smooth.share(1e-5f, -0.7f), 1, 1e-3f);
    EXPECT_NEAR(rough.share(1e-5f, -0.7f), 1, 1e-3f);
    EXPECT_LT(rough.share(100, -0.5f), 0.01f);
  }
  // A surface without a normal has no horizon.
  EXPECT_EQ(horizon_of(stretched_lobe(0.5f, 1.0f), 0.0f).share(30, 0.0f), 1);
}

// What a metal reflects of lamps all around, by quadrature over its facets, against the closed form.
TEST(Horizon, LampsAreReflectedAsFacetsReflectThem) {
  constexpr int kLamps = 200;
  constexpr double kSharpness = 30;
  const Vec3d n{0, 0, 1};
  struct Bound {
    double roughness, nv, error;  // max error with the horizon, relative
  };
  for (const auto& [roughness, nv, bound] : {Bound{0.3, 0.3, 0.16},
                                             {0.3, 0.6, 0.065},
                                             {0.5, 0.3, 0.23},
                                             {0.5, 0.6, 0.13},
                                             {0.7, 0.3, 0.28},
                                             {0.7, 0.6, 0.21}}) {
    const Vec3d v{std::sqrt(1 - nv * nv), 0, nv};
    const LobeFrame<double> frame = lobe_frame(reflection_tables().base, n, v, roughness);
    const StretchedLobe<double> lobe = stretched_lobe(frame.roughness, frame.stretch);
    const Horizon<double> horizon = horizon_of(lobe, dot(frame.axis, n));
    double sum = 0, with = 0, without = 0;
    for (int k = 0; k < kLamps; ++k) {
      const Vec3d lamp = to_double(fibonacci_direction(k, kLamps)), gap = frame.axis - lamp;
      double truth = 0, total = 0;
      for_reflections(nv, roughness, [&](double weight, const Vec3d& l, double vh) {
        const double share = weight * (1 - fresnel(0.0, vh)) / 2;
        for (const double y : {l.y, -l.y})
          truth += share * std::exp(kSharpness * (dot(Vec3d{l.x, y, l.z}, lamp) - 1));
        total += 2 * share;
      });
      const double closed = sg_reflected(kSharpness, lobe, dot(gap, gap), square(dot(gap, frame.across)));
      with += std::abs(closed * horizon.share(kSharpness, dot(n, lamp)) - truth / total);
      without += std::abs(closed - truth / total);
      sum += truth / total;
    }
    EXPECT_LT(with, without) << roughness << ' ' << nv;
    EXPECT_LT(with / sum, bound) << roughness << ' ' << nv;
  }
}

}  // namespace
}  // namespace cei3d
