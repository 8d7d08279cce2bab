// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/math/rng.h"
#include "model/light/envmap.h"
#include "model/light/fit.h"
#include "model/light/sg_mixture.h"

namespace cei3d {
namespace {

Vec3f random_direction(uint64_t i) {
  Rng rng(5, 0, i);
  return normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
}
void expect_near(Vec3f a, Vec3f b, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance);
}

TEST(Envmap, CornersAndQuartersLookWhereTheConventionsSay) {
  const int w = 64, h = 32;
  expect_near(env_direction(32, 16, w, h, EnvUp::z), {1, 0, 0}, 1e-6f);
  expect_near(env_direction(16, 16, w, h, EnvUp::z), {0, 1, 0}, 1e-6f);
  expect_near(env_direction(48, 16, w, h, EnvUp::z), {0, -1, 0}, 1e-6f);
  expect_near(env_direction(0, 16, w, h, EnvUp::z), {-1, 0, 0}, 1e-6f);
  expect_near(env_direction(9, 0, w, h, EnvUp::z), {0, 0, 1}, 1e-6f);
  expect_near(env_direction(0, 16, w, h, EnvUp::y), {0, 0, -1}, 1e-6f);
  expect_near(env_direction(16, 16, w, h, EnvUp::y), {1, 0, 0}, 1e-6f);
  expect_near(env_direction(32, 16, w, h, EnvUp::y), {0, 0, 1}, 1e-6f);
  expect_near(env_direction(48, 16, w, h, EnvUp::y), {-1, 0, 0}, 1e-6f);
  expect_near(env_direction(5, 0, w, h, EnvUp::y), {0, 1, 0}, 1e-6f);
}

TEST(Envmap, PixelsAndDirectionsAreInverse) {
  for (const EnvUp up : {EnvUp::z, EnvUp::y})
    for (uint64_t i = 0; i < 200; ++i) {
      const Vec3f d = random_direction(i);
      const Vec2f p = env_pixel(d, 100, 50, up);
      expect_near(env_direction(p.x, p.y, 100, 50, up), d, 2e-4f);
    }
}

TEST(Envmap, QuickTapsAreThoseOfTheExactAngles) {
  const auto at = [](const EnvTaps& t) {  // a map that is smooth across the seam
    Vec3f sum{0, 0, 0};
    for (int k = 0; k < 4; ++k) {
      const float turn = 2 * kPi * float(t.pixel[k] % 100) / 100;
      sum += Vec3f{std::cos(turn), std::sin(turn), float(t.pixel[k] / 100) / 50} * t.weight[k];
    }
    return sum;
  };
  for (uint64_t i = 0; i < 2000; ++i) {
    const Vec3f d = random_direction(i);
    expect_near(at(quick_env_taps(d, 100, 50)), at(env_taps(d, 100, 50)), 1e-4f);
  }
}

TEST(Envmap, SolidAnglesFillTheSphereAndResamplingKeepsTheIntegral) {
  Image map(50, 25, 3);
  for (size_t i = 0; i < map.data.size(); ++i) map.data[i] = Rng(1, 0, i).uniform();
  const auto integral = [](const Image& m, int c) {
    double sum = 0;
    for (int y = 0; y < m.height; ++y)
      for (int x = 0; x < m.width; ++x)
        sum += env_solid_angle(y, m.width, m.height) * (c < 0 ? 1.0 : m.at(x, y)[c]);
    return sum;
  };
  EXPECT_NEAR(integral(map, -1), 4 * M_PI, 1e-4);
  const Image small = env_resample(map, 8);
  ASSERT_EQ(small.width, 16);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(integral(small, c), integral(map, c), 1e-4);
}

TEST(Envmap, BilinearLookupHitsPixelCentersAndWraps) {
  Image map(8, 4, 3);
  for (size_t i = 0; i < map.data.size(); ++i) map.data[i] = Rng(2, 0, i).uniform();
  expect_near(env_radiance(map, env_direction(3.5f, 1.5f, 8, 4)), map.rgb(3, 1), 1e-5f);
  expect_near(env_radiance(map, env_direction(0, 1.5f, 8, 4)), (map.rgb(0, 1) + map.rgb(7, 1)) * 0.5f, 1e-4f);
}

SgMixture some_light() {
  return {{{normalize(Vec3f{1, 2, 3}), 30, {3, 2, 1}},
           {{0, 0, -1}, 2, {0.2f, 0.3f, 0.4f}},
           {normalize(Vec3f{-2, 1, 0}), 8, {0.5f, 0.6f, 0.9f}}}};
}

TEST(SgMixture, ArraysRoundTripAndBadOnesAreRefused) {
  const SgMixture light = some_light();
  const SgMixture back = light_from_array(to_array(light));
  ASSERT_EQ(back.lobes.size(), 3u);
  for (int k = 0; k < 3; ++k) {
    expect_near(back.lobes[k].axis, light.lobes[k].axis, 1e-6f);
    EXPECT_EQ(back.lobes[k].lambda, light.lobes[k].lambda);
  }
  // Light files of other programs hold raw values: neither signs nor lengths are normalized.
  const SgMixture raw = light_from_array(std::vector<float>{0, 0, 5, -7, 1, -2, 3});
  expect_near(raw.lobes[0].axis, {0, 0, 1}, 1e-6f);
  EXPECT_EQ(raw.lobes[0].lambda, 7);
  EXPECT_EQ(raw.lobes[0].mu.y, 2);
  EXPECT_THROW(light_from_array(std::vector<float>(6)), Error);
  EXPECT_THROW(light_from_array({}), Error);
  EXPECT_THROW(light_from_array(std::vector<float>(7, 0.0f)), Error);
  EXPECT_THROW(light_from_array(std::vector<float>{0, 0, 1, NAN, 1, 1, 1}), Error);
}

TEST(SgMixture, TurningTheLightIsTurningTheViewer) {
  const float c = std::cos(0.7f), s = std::sin(0.7f);
  const Mat3f turn{{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
  const SgMixture light = some_light(), turned = rotated(light, turn);
  for (uint64_t i = 0; i < 20; ++i) {
    const Vec3f d = random_direction(i);
    expect_near(radiance(turned, turn * d), radiance(light, d), 1e-5f);
    expect_near(radiance(scaled(light, {2, 3, 4}), d), radiance(light, d) * Vec3f{2, 3, 4}, 1e-5f);
  }
}

Image draw(const SgMixture& light, int height) {
  Image map(2 * height, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const Vec3f c = radiance(light, env_direction(float(x) + 0.5f, float(y) + 0.5f, 2 * height, height));
      for (int k = 0; k < 3; ++k) map.at(x, y)[k] = c[k];
    }
  return map;
}

double relative_error(const SgMixture& got, const SgMixture& want) {
  double error = 0, total = 0;
  for (uint64_t i = 0; i < 2000; ++i) {
    const Vec3f d = random_direction(i), a = radiance(got, d), b = radiance(want, d);
    for (int c = 0; c < 3; ++c) error += std::abs(a[c] - b[c]), total += b[c];
  }
  return error / total;
}

TEST(FitLobes, RecoversALightOfLobes) {
  const SgMixture light = some_light();
  EXPECT_LT(relative_error(fit_lobes(make_device(), draw(light, 32), {64, 600, 32, 0}), light), 0.02);
}

TEST(FitLobes, SeesThroughTheReflectionLobe) {
  // The light behind a blur of sharpness 60 is found again although the fit only looks at the blurred
  // picture.
  const SgMixture light = some_light();
  EXPECT_LT(relative_error(fit_lobes(make_device(), draw(light, 32), {64, 600, 32, 60}), light), 0.08);
}

TEST(FitLobes, IsTheSameEveryTimeAndRefusesNonsense) {
  const Image map = draw(some_light(), 16);
  EXPECT_EQ(to_array(fit_lobes(make_device(), map, {32, 50, 16, 0})),
            to_array(fit_lobes(make_device(), map, {32, 50, 16, 0})));
  Image bad = map;
  bad.data[7] = NAN;
  EXPECT_THROW(fit_lobes(make_device(), bad), Error);
  EXPECT_THROW(fit_lobes(make_device(), Image()), Error);
}

}  // namespace
}  // namespace cei3d
