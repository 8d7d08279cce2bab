// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/handlers.h"

#include <gtest/gtest.h>

#include "core/math/rng.h"

namespace cei3d {
namespace {

// Hits on both faces of a thin square sheet.
std::vector<Hit> sheet_hits(int n) {
  std::vector<Hit> hits(n);
  for (int i = 0; i < n; ++i) {
    Rng rng(7, 0, i);
    const float side = i % 2 ? 1.0f : -1.0f;
    hits[i].position = {rng.uniform() - 0.5f, rng.uniform() - 0.5f, side * 0.002f};
    hits[i].normal = {0, 0, side};
  }
  return hits;
}

bool near_on_same_side(Vec3f p, Vec3f n, Vec3f q, Vec3f m, float spacing) {
  return dot(p - q, p - q) < spacing * spacing && dot(n, m) > 0;
}

TEST(ThinHits, KeepsThePointsThatTheBruteForceRuleKeeps) {
  const float spacing = 0.03f;
  const std::vector<Hit> hits = sheet_hits(4000);
  const HandlerPoints kept = thin_hits(hits, std::vector<float>(hits.size(), 0.01f), spacing);
  std::vector<Hit> expected;
  for (const Hit& h : hits) {
    bool covered = false;
    for (const Hit& k : expected)
      covered |= near_on_same_side(h.position, h.normal, k.position, k.normal, spacing);
    if (!covered) expected.push_back(h);
  }
  ASSERT_EQ(kept.positions.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(kept.positions[i].x, expected[i].position.x);
  EXPECT_EQ(kept.spacing, spacing);
}

TEST(ThinHits, EveryHitHasAKeptPointOnItsOwnSide) {
  const std::vector<Hit> hits = sheet_hits(3000);
  const HandlerPoints kept = thin_hits(hits, std::vector<float>(hits.size(), 0.01f), 0.05f);
  for (const Hit& h : hits) {
    bool covered = false;
    for (size_t k = 0; k < kept.positions.size(); ++k)
      covered |= near_on_same_side(h.position, h.normal, kept.positions[k], kept.normals[k], 0.05f);
    EXPECT_TRUE(covered);
  }
}

TEST(ThinHits, RemembersTheBestFootprint) {
  Hit h{};
  h.normal = {0, 0, 1};
  const std::vector<Hit> hits{h, h, h};
  const HandlerPoints kept = thin_hits(hits, std::vector<float>{0.02f, 0.005f, 0.01f}, 0.1f);
  ASSERT_EQ(kept.positions.size(), 1u);
  EXPECT_EQ(kept.footprints[0], 0.005f);
}

TEST(ThinHits, NothingFromNothing) { EXPECT_TRUE(thin_hits({}, {}, 0.1f).positions.empty()); }

}  // namespace
}  // namespace cei3d
