// SPDX-License-Identifier: Apache-2.0
// What is drawn at random, against the integrals that it stands for.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/math/rng.h"
#include "core/math/sg.h"
#include "core/math/split_sum.h"
#include "engine/synthetic/lamps.h"
#include "engine/synthetic/sample_sequence.h"
#include "engine/synthetic/scattering.h"

namespace cei3d {
namespace {

TEST(SampleSequence, SixteenSamplesOfAnyPairFallIntoSixteenBoxesOfEveryShape) {
  for (uint64_t key = 0; key < 20; ++key)
    for (int pair = 0; pair < 5; ++pair)
      for (const int columns : {1, 2, 4, 8, 16}) {
        const int rows = 16 / columns;
        std::set<int> boxes;
        for (uint32_t i = 0; i < 16; ++i) {
          SampleSequence s(key, i);
          for (int skipped = 0; skipped < pair; ++skipped) s.pair();
          const Vec2<float> u = s.pair();
          ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
          boxes.insert(int(u.x * float(columns)) * 16 + int(u.y * float(rows)));
        }
        ASSERT_EQ(boxes.size(), 16u) << key << ' ' << pair << ' ' << columns;
      }
}

TEST(SampleSequence, PairsOfASampleKnowNothingOfEachOther) {
  double sum[3] = {0, 0, 0};
  constexpr int kKeys = 4000;
  for (uint64_t key = 0; key < kKeys; ++key) {
    SampleSequence s(key, 3);
    const Vec2<float> a = s.pair(), b = s.pair();
    sum[0] += (a.x - 0.5) * (a.y - 0.5);
    sum[1] += (a.x - 0.5) * (b.x - 0.5);
    sum[2] += (a.y - 0.5) * (b.x - 0.5);
  }
  // A product of independent numbers has variance 1/144.
  for (const double s : sum) EXPECT_LT(std::abs(s / kKeys), 4.0 / 12 / std::sqrt(double(kKeys)));
}

TEST(LightSampler, RadianceOverDensityIsTheIntegralOfTheLight) {
  const SgMixture light{{{{0, 0, 1}, 0, {0.01f, 0.02f, 0.03f}},
                         {normalize(Vec3f{1, 2, -1}), 5, {1, 0.5f, 0.2f}},
                         {{0, -1, 0}, 3000, {200, 300, 100}}}};
  const LightSampler sampler(light);
  Vec3d sum{0, 0, 0}, flux{0, 0, 0}, truth{0, 0, 0}, true_flux{0, 0, 0};
  constexpr uint32_t kSamples = 65536;
  for (uint32_t i = 0; i < kSamples; ++i) {
    SampleSequence s(1, i);
    const Vec2<float> pick = s.pair();
    const Vec3f w = sampler.sample(pick.x, s.pair());
    ASSERT_NEAR(length(w), 1, 1e-5);
    const LightSampler::Value v = sampler.at(w);
    const Vec3f expected = radiance(light, w);
    ASSERT_NEAR(v.radiance.y, expected.y, 1e-4f * expected.y);
    sum += to_double(v.radiance / v.density) / double(kSamples);
    flux += to_double(w) * double(v.radiance.y / v.density) / double(kSamples);
  }
  for (const SgLobe& l : light.lobes) {
    truth += to_double(l.mu) * sg_integral(double(l.lambda));
    // Mean cosine of a lobe to its axis: coth(lambda) - 1 / lambda.
    const double x = l.lambda, mean = x > 0 ? 1 / std::tanh(x) - 1 / x : 0;
    true_flux += to_double(l.axis) * (double(l.mu.y) * sg_integral(x) * mean);
  }
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(sum[c], truth[c], 0.006 * truth[c]);
    EXPECT_NEAR(flux[c], true_flux[c], 0.012);  // four standard deviations
  }
}

TEST(Lamps, TurnWithTheCamera) {
  const SgMixture light = light_by_name("daylight");
  for (const double azimuth : {0.0, 0.7, 2.5, -1.9}) {
    const SgMixture turned = turned_with(light, {3 * std::cos(azimuth), 3 * std::sin(azimuth), 1.2});
    for (uint64_t i = 0; i < 50; ++i) {
      Rng rng(1, 2, i);
      const Vec3f w = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
      const float c = float(std::cos(-azimuth)), s = float(std::sin(-azimuth));
      const Vec3f back{c * w.x - s * w.y, s * w.x + c * w.y, w.z};
      EXPECT_NEAR(radiance(turned, w).x, radiance(light, back).x, 1e-4 + 1e-4 * radiance(light, back).x);
    }
  }
  EXPECT_THROW(light_by_name("moon"), Error);
}

// Mean of reflectance over density.
Vec3d reflectance(const Scattering& s) {
  Vec3d sum{0, 0, 0};
  constexpr uint32_t kSamples = 16384;
  for (uint32_t i = 0; i < kSamples; ++i) {
    SampleSequence sequence(9, i);
    const Vec2<float> pick = sequence.pair();
    const Vec3f l = s.sample(pick.x, sequence.pair());
    if (l.z > 0) sum += to_double(s.reflected(l) / s.density(l)) / double(kSamples);
  }
  return sum;
}

TEST(Scattering, SamplesReflectWhatQuadratureSays) {
  for (const float roughness : {0.1f, 0.3f, 0.8f})
    for (const float nv : {0.2f, 0.6f, 0.97f})
      for (const auto& [metalness, specular] :
           {std::pair{0.0f, 0.5f}, {0.0f, 0.1f}, {0.5f, 0.5f}, {1.0f, 0.1f}}) {
        const Vec3f view{std::sqrt(1 - nv * nv), 0, nv}, color{0.9f, 0.5f, 0.2f};
        const Vec3d got = reflectance(
            Scattering({0, 0, 1}, view, {roughness, specular, metalness}, color, Diffuse::lambert));
        const SplitSum<double> e = split_sum_integral(nv, roughness);
        for (int c = 0; c < 3; ++c) {
          const double f0 = (1 - metalness) * 0.08 * specular + metalness * color[c];
          const double f90 = (1 - metalness) * 2 * specular + metalness;
          EXPECT_NEAR(got[c], (1 - metalness) * color[c] + f0 * e.scale + f90 * e.bias, 0.008)
              << roughness << ' ' << nv << ' ' << metalness;
        }
      }
}

TEST(Scattering, BurleysBaseReflectsWhatItsMeanSays) {
  for (const float roughness : {0.1f, 0.9f})
    for (const float nv : {0.2f, 0.9f}) {
      const Vec3f view{std::sqrt(1 - nv * nv), 0, nv}, color{0.8f, 0.8f, 0.8f};
      const Vec3d got = reflectance(Scattering({0, 0, 1}, view, {roughness, 0, 0}, color, Diffuse::burley));
      EXPECT_NEAR(got.x, 0.8 * diffuse_view(double(nv), double(roughness)), 0.02);
    }
}

}  // namespace
}  // namespace cei3d
