// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/blur_ladder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/math/facets.h"
#include "core/math/rng.h"
#include "model/light/envmap.h"

namespace cei3d {
namespace {

constexpr int kHeight = 48, kCells = 2 * kHeight * kHeight;

// Twelve soft lamps.
Vec3f radiance(Vec3f direction) {
  float sum = 0.05f;
  for (uint64_t k = 0; k < 12; ++k) {
    Rng rng(3, 0, k);
    const Vec3f axis = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
    sum += std::exp(70 * (dot(direction, axis) - 1));
  }
  return Vec3f{1, 1, 1} * sum;
}

Blurred blurs_of(BlurLadder& ladder) {
  std::vector<Vec3f> light;
  for (int i = 0; i < kCells; ++i)
    light.push_back(radiance(env_direction(float(i % (2 * kHeight)) + 0.5f, float(i / (2 * kHeight)) + 0.5f,
                                           2 * kHeight, kHeight)));
  Blurred out;
  for (int level = 0; level < BlurLadder::kLevels; ++level) out.set(level, light, ladder);
  return out;
}

SplitRow seen_at(float nv) {
  SplitRow row{};
  row.normal = {0, 0, 1};
  row.to_camera = {std::sqrt(1 - nv * nv), 0, nv};
  row.nv = nv;
  return row;
}

// Mean radiance of what a rough surface reflects, by quadrature over its facets; `turn` turns the light about
// the normal.
double reflected(float nv, double roughness, float turn) {
  double sum = 0, total = 0;
  for_reflections(nv, roughness, [&](double weight, const Vec3d& l, double vh) {
    const double share = weight * (1 - fresnel(0.0, vh));
    for (const double y : {l.y, -l.y}) {
      const Vec3f d{float(std::cos(turn) * l.x - std::sin(turn) * y),
                    float(std::sin(turn) * l.x + std::cos(turn) * y), float(l.z)};
      sum += share * radiance(d).x;
      total += share;
    }
  });
  return sum / total;
}

TEST(BlurLadder, StretchedLobesAreNearerToTheFacetsThanRoundOnes) {
  BlurLadder ladder(kHeight);
  const Blurred blurred = blurs_of(ladder);
  const auto at = [](Vec3f d, float turn) {
    return Vec3f{std::cos(turn) * d.x - std::sin(turn) * d.y, std::sin(turn) * d.x + std::cos(turn) * d.y,
                 d.z};
  };
  double stretched_error = 0, round_error = 0, square_sum = 0;
  for (const float roughness : {0.25f, 0.4f})
    for (const float nv : {0.25f, 0.4f, 0.6f})
      for (int k = 0; k < 24; ++k) {
        const float turn = 2 * kPi * float(k) / 24;
        SplitRow row = seen_at(nv);
        row.to_camera = at(row.to_camera, turn);
        const double want = reflected(nv, roughness, turn);
        const ReflectedSky sky = reflected_sky(row, ReflectionPart::base, roughness, kHeight);
        EXPECT_EQ(sky.count, ReflectedSky::kMaxTaps);
        const ReflectionAxis<float> round = reflection_axis(reflection_axis_table(ReflectionPart::base),
                                                            row.normal, row.to_camera, roughness);
        ReflectedSky once = sky;
        once.lobe = BlurLadder::place(round.roughness);
        once.count = 4;
        const EnvTaps taps = env_taps(round.axis, 2 * kHeight, kHeight);
        std::copy(taps.pixel, taps.pixel + 4, once.pixel.begin());
        std::copy(taps.weight, taps.weight + 4, once.weight.begin());
        stretched_error += square(radiance_at(blurred, sky).x - want);
        round_error += square(radiance_at(blurred, once).x - want);
        square_sum += square(want);
      }
  EXPECT_LT(stretched_error, 0.8 * round_error);
  EXPECT_LT(stretched_error, 0.005 * square_sum);
}

TEST(BlurLadder, LookupAndScatteringAreAdjoint) {
  BlurLadder ladder(kHeight);
  const Blurred blurred = blurs_of(ladder);
  for (const float nv : {0.2f, 0.95f}) {
    const ReflectedSky sky = reflected_sky(seen_at(nv), ReflectionPart::base, 0.3f, kHeight);
    EXPECT_EQ(sky.count, nv < 0.5f ? ReflectedSky::kMaxTaps : 4);
    Blurred scattered;
    for (int level = 0; level < BlurLadder::kLevels; ++level) scattered.clear(level, kCells);
    scatter_radiance(sky, {2, 0.5f, -1}, scattered);
    double sum = 0;
    for (int level = 0; level < BlurLadder::kLevels; ++level)
      for (size_t i = 0; i < kCells; ++i)
        for (int c = 0; c < 3; ++c) sum += double(scattered.of(level)[i][c]) * blurred.of(level)[i][c];
    EXPECT_NEAR(sum, double(dot(radiance_at(blurred, sky), Vec3f{2, 0.5f, -1})), 1e-4 * std::abs(sum));
  }
}

}  // namespace
}  // namespace cei3d
