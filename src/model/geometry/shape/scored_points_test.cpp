// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/scored_points.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/json.h"
#include "core/math/rng.h"
#include "model/geometry/shape/handlers.h"
#include "model/geometry/shape/test_regions.h"

namespace cei3d {
namespace {

constexpr float kRadius = 0.8f, kSpacing = 0.05f;

Vec3f random_direction(uint64_t seed, int i) {
  Rng rng(seed, 0, i);
  return normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
}

// The sphere's handler points, scored by how far they are above the plane z = height: 0 below by a spacing, 1
// above.
ScoredPoints::Data cap(float height) {
  std::vector<Hit> hits;
  for (int i = 0; i < 60000; ++i) {
    const Vec3f n = random_direction(7, i);
    hits.push_back({n * kRadius, n, n, 0, 0, 0});
  }
  HandlerPoints points = thin_hits(hits, std::vector<float>(hits.size(), kSpacing), kSpacing);
  ScoredPoints::Data d{std::move(points.positions), std::move(points.normals), {}, kSpacing};
  for (const Vec3f p : d.positions)
    d.scores.push_back(clamp(0.5f + (p.z - height) / (2 * kSpacing), 0.0f, 1.0f));
  return d;
}

TEST(ScoredPoints, ThePartEndsWhereTheScoresCrossOneHalf) {
  const Region region{ScoredPoints(cap(0.2f))};
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f n = random_direction(8, i), p = n * kRadius;
    if (std::abs(p.z - 0.2f) < 0.25f * kSpacing) continue;  // a border four times finer than the points
    EXPECT_EQ(region.contains(p, n), p.z > 0.2f) << p.z;
    inside += p.z > 0.2f;
  }
  EXPECT_GT(inside, 5000);
}

TEST(ScoredPoints, FollowsBruteForceOverAllPoints) {
  const ScoredPoints::Data d = cap(-0.3f);
  const ScoredPoints part(d);
  EXPECT_LT(part.data().positions.size(), d.positions.size());  // those that cannot matter are dropped
  for (int i = 0; i < 3000; ++i) {
    const Vec3f n = random_direction(9, i), p = n * (kRadius + 0.002f);
    double sum = 0, weight = 0;
    for (size_t k = 0; k < d.positions.size(); ++k) {
      const Vec3f to = d.positions[k] - p;
      const double t = 1 - dot(to, to) / square(2.5 * kSpacing);
      if (t <= 0 || dot(d.normals[k], n) <= 0) continue;
      sum += t * t * t * d.scores[k];
      weight += t * t * t;
    }
    const double expected = weight > 0 ? sum / weight : 0;
    if (expected >= 0.5)
      EXPECT_NEAR(part.score(p, n), expected, 1e-4);
    else
      EXPECT_LT(part.score(p, n), 0.5 + 1e-4);
  }
}

TEST(ScoredPoints, LeaveTheOtherSideOfASheetAlone) {
  const ScoredPoints part(cap(0.2f));
  const Vec3f top{0, 0, kRadius};
  EXPECT_GT(part.score(top, {0, 0, 1}), 0.9f);
  EXPECT_EQ(part.score(top, {0, 0, -1}), 0);
  EXPECT_EQ(part.score(-top, {0, 0, -1}), 0);
  EXPECT_EQ(ScoredPoints().score(top, {0, 0, 1}), 0);
}

TEST(ScoredPoints, ComeBackFromTensorsAsTheyWere) {
  const Region region{ScoredPoints(cap(0.2f))};
  Tensors tensors;
  Json head;
  region.save(tensors, head);
  const Region again = Region::load(tensors, Json::parse(head.dump()));
  for (int i = 0; i < 5000; ++i) {
    const Vec3f n = random_direction(10, i), p = n * kRadius;
    EXPECT_EQ(again.scored().score(p, n), region.scored().score(p, n));
  }
  expect_damage_is_refused(region);
}

}  // namespace
}  // namespace cei3d
