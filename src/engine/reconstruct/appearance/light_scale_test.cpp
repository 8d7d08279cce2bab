// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/light_scale.h"

#include <gtest/gtest.h>

#include "core/math/rng.h"

namespace cei3d {
namespace {

// Vertices of a brown surface, whose samples reflect t times what the model says, and whose diffuse light
// varies by `variation`.
struct Drawn {
  std::vector<std::vector<ReflectionSample>> vertices;
  Drawn(Vec3f t, float variation) {
    for (uint64_t v = 0; v < 300; ++v) {
      Rng rng(1, 2, v);
      const Vec3f d = Vec3f{0.3f, 0.16f, 0.05f} * (0.5f + rng.uniform());
      std::vector<ReflectionSample> samples;
      for (int k = 0; k < 40; ++k) {
        const Vec3f reflected = Vec3f{0.05f, 0.05f, 0.05f} * rng.uniform();
        const float change = 1 + variation * float(rng.normal());
        const Vec3f noise{rng.normal(), rng.normal(), rng.normal()};
        samples.push_back({{1, 1, 1}, {1, 1, 1}, reflected, d * change + reflected * t + noise * 0.002f});
      }
      vertices.push_back(std::move(samples));
    }
  }
  SampleNoise noise() const {
    NoiseSums sums;
    for (const auto& samples : vertices) sums.add(samples);
    return sums.noise();
  }
  LightScale scale(const SampleNoise& noise) const {
    std::vector<ScaleEquations> places(10);
    for (size_t v = 0; v < vertices.size(); ++v) places[v % places.size()].add(vertices[v], noise);
    return light_scale(places);
  }
};

TEST(LightScale, FindsTheNoiseAndTheFactor) {
  const Vec3f t{1.2f, 0.9f, 1.1f};
  const Drawn drawn(t, 0.1f);
  const SampleNoise noise = drawn.noise();
  EXPECT_NEAR(std::sqrt(noise.diffuse), 0.1, 0.03);
  const LightScale got = drawn.scale(noise);
  EXPECT_LT(length(got.factor - t), 0.05f);
  for (int c = 0; c < 3; ++c) {
    const double error = std::sqrt(got.covariance.row[c][c]);
    EXPECT_GT(error, 0.2 * std::abs(got.factor[c] - t[c]) / t[c]);
    EXPECT_LT(error, 0.2);
  }
}

// A model that took the surface's variation for orange reflections is put right.
TEST(LightScale, VariationInTheColorOfTheSurfaceIsNoReflection) {
  Drawn drawn({1, 1, 1}, 0.1f);
  for (auto& samples : drawn.vertices)
    for (ReflectionSample& s : samples) s.reflected = s.reflected * Vec3f{2, 1, 0.3f};  // the model's
  const Vec3f t = drawn.scale(drawn.noise()).factor;
  EXPECT_NEAR(t.x * 2, 1, 0.1);
  EXPECT_NEAR(t.z * 0.3f, 1, 0.1);
}

TEST(LightScale, IsUnknownWhereNothingReflects) {
  Drawn drawn({1, 1, 1}, 0.1f);
  for (auto& samples : drawn.vertices)
    for (ReflectionSample& s : samples) s.reflected = {0, 0, 0};
  const LightScale got = drawn.scale(drawn.noise());
  EXPECT_EQ(got.factor.x, 1);
  EXPECT_GT(got.covariance.row[0].x, 1);
}

}  // namespace
}  // namespace cei3d
