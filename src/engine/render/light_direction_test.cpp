// SPDX-License-Identifier: Apache-2.0
#include "engine/render/light_direction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/brdf.h"
#include "core/math/fibonacci.h"

namespace cei3d {
namespace {

TEST(LightDirection, IsTwoThirdsOfTheNormalUnderEvenLight) {
  const DirectionMap map = light_directions(SkyRadiance(kSkyDirections, Vec3f{1, 1, 1}));
  for (const Vec3f n : {Vec3f{0, 0, 1}, normalize(Vec3f{1, -2, 0.5f})})
    EXPECT_LT(length(map.at(n) - n * (2.0f / 3)), 0.02f);
}

TEST(LightDirection, IsThatOfTheLampThatAlmostAllLightComesFrom) {
  SkyRadiance sky(kSkyDirections, Vec3f{0.001f, 0.001f, 0.001f});
  sky[200] = {50, 50, 50};
  const Vec3f lamp = sky_directions()[200];
  const DirectionMap map = light_directions(sky);
  EXPECT_LT(length(map.at(lamp) - lamp), 0.02f);
  EXPECT_LT(length(map.at(normalize(lamp + Vec3f{0.4f, -0.3f, 0.2f})) - lamp), 0.05f);
}

// Of light from one side, Burley's diffuse term by quadrature against the view factors, relative to what each
// says of the view along the normal.
TEST(LightDirection, MakesTheViewFactorThatOfBurleysTermUnderLightFromOneSide) {
  const Vec3f n{0, 0, 1}, side = normalize(Vec3f{1, 0, 0.8f});
  SkyRadiance sky;
  for (const Vec3f d : sky_directions()) {
    const float r = std::exp(6 * (dot(d, side) - 1));
    sky.push_back({r, r, r});
  }
  const DirectionMap map = light_directions(sky);
  for (const float roughness : {0.2f, 0.5f, 0.9f}) {
    const auto burley = [&](Vec3f v) {
      double sum = 0;
      for (int k = 0; k < kSkyDirections; ++k) {
        const Vec3f l = sky_directions()[size_t(k)];
        if (dot(l, n) <= 0) continue;
        sum += double(sky[size_t(k)].x) * dot(l, n) *
               burley_diffuse(dot(l, n), dot(v, n), dot(l, normalize(l + v)), roughness);
      }
      return sum;
    };
    double with = 0, without = 0;
    for (int k = 0; k < 200; ++k) {
      const Vec3f v = fibonacci_direction(k, 200);
      if (v.z < 0.1f || v.z > 0.5f) continue;
      const double truth = burley(v) / burley(n), lit = diffuse_view(v.z, roughness, dot(v, map.at(n))),
                   lit_along = diffuse_view(1.0f, roughness, dot(n, map.at(n)));
      with += square(lit / lit_along - truth);
      without += square(diffuse_view(v.z, roughness) / diffuse_view(1.0f, roughness) - truth);
    }
    EXPECT_LT(with, 0.35 * without) << roughness;
  }
}

}  // namespace
}  // namespace cei3d
