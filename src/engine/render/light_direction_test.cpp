// SPDX-License-Identifier: Apache-2.0
#include "engine/render/light_direction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/brdf.h"
#include "core/math/fibonacci.h"

namespace cei3d {
namespace {

TEST(LightDirection, OfEvenLightIsThatOfEvenLight) {
  const LightDirectionMap map = light_directions(SkyRadiance(kSkyDirections, Vec3f{1, 1, 1}));
  for (const Vec3f n : {Vec3f{0, 0, 1}, normalize(Vec3f{1, -2, 0.5f})}) {
    const Vec3f v = normalize(n + Vec3f{0.7f, 0.2f, -0.3f});
    const DiffuseLight<float> got = map.at(n).towards(v), want = even_light(dot(n, v));
    EXPECT_NEAR(got.lv, want.lv, 0.02f);
    EXPECT_NEAR(got.grazing, want.grazing, 0.004f);
    EXPECT_NEAR(got.grazing_lv, want.grazing_lv, 0.004f);
  }
}

TEST(LightDirection, IsThatOfTheLampThatAlmostAllLightComesFrom) {
  SkyRadiance sky(kSkyDirections, Vec3f{0.001f, 0.001f, 0.001f});
  sky[200] = {50, 50, 50};
  const Vec3f lamp = sky_directions()[200];
  const LightDirectionMap map = light_directions(sky);
  EXPECT_LT(length(map.at(lamp).mean - lamp), 0.02f);
  EXPECT_LT(length(map.at(normalize(lamp + Vec3f{0.4f, -0.3f, 0.2f})).mean - lamp), 0.05f);
}

// A sky that is bright on one side.
SkyRadiance one_sided_sky(Vec3f side) {
  SkyRadiance sky;
  for (const Vec3f d : sky_directions()) {
    const float r = std::exp(6 * (dot(d, side) - 1));
    sky.push_back({r, r, r});
  }
  return sky;
}

// Radiance towards v by Burley's term, by quadrature, over that of a Lambertian surface.
double burley_over_lambert(const SkyRadiance& sky, Vec3f n, Vec3f v, float roughness) {
  double burley = 0, lambert = 0;
  for (int k = 0; k < kSkyDirections; ++k) {
    const Vec3f l = sky_directions()[size_t(k)];
    if (dot(l, n) <= 0) continue;
    const double arrives = double(sky[size_t(k)].x) * dot(l, n);
    lambert += arrives;
    burley += arrives * burley_diffuse(dot(l, n), dot(v, n), dot(l, normalize(l + v)), roughness);
  }
  return burley / lambert;
}

// From normals that face the bright side to those that its light reaches at grazing angles.
TEST(LightDirection, MakesTheDiffuseTermBurleysUnderLightFromOneSide) {
  const Vec3f side = normalize(Vec3f{1, 0, 0.8f});
  const SkyRadiance sky = one_sided_sky(side);
  const LightDirectionMap map = light_directions(sky);
  for (const float roughness : {0.2f, 0.5f, 0.9f})
    for (const float turn : {0.0f, 0.8f, 1.3f, 1.6f}) {
      const Vec3f n = normalize(side * std::cos(turn) + normalize(Vec3f{-0.8f, 0.3f, 1}) * std::sin(turn));
      double with = 0, without = 0;
      int count = 0;
      for (int k = 0; k < 400; ++k) {
        const Vec3f v = fibonacci_direction(k, 400);
        const float nv = dot(n, v);
        if (nv < 0.1f) continue;
        const double truth = burley_over_lambert(sky, n, v, roughness);
        with += square(diffuse_view(nv, roughness, map.at(n).towards(v)) / truth - 1);
        without += square(diffuse_view(nv, roughness, even_light(nv)) / truth - 1);
        ++count;
      }
      EXPECT_LT(std::sqrt(with / count), 0.02) << roughness << ' ' << turn;
      EXPECT_LT(with, without) << roughness << ' ' << turn;
    }
}

}  // namespace
}  // namespace cei3d
