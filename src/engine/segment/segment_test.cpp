// SPDX-License-Identifier: Apache-2.0
// Parts of objects that are known exactly: spheres with painted caps, and spheres that meet in a crease.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <set>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/math/rng.h"
#include "engine/segment/grow.h"
#include "engine/segment/random_walk.h"

namespace cei3d {
namespace {

constexpr float kSpacing = 0.05f;
constexpr Vec3f kPink{0.7f, 0.4f, 0.3f}, kWhite{0.7f, 0.65f, 0.6f}, kDark{0.1f, 0.05f, 0.05f};

struct Object {
  HandlerPoints points;
  std::vector<Vec3f> colors;  // linear
};

Vec3f random_direction(uint64_t seed, int i) {
  Rng rng(seed, 0, i);
  return normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
}

// Points of spheres of radius 0.5, without what lies inside another one; colors with noise.
Object spheres(std::span<const Vec3f> centers, const std::function<Vec3f(Vec3f)>& color) {
  std::vector<Hit> hits;
  for (int i = 0; i < 40000; ++i) {
    const Vec3f n = random_direction(3, i), p = centers[i % centers.size()] + n * 0.5f;
    bool inside = false;
    for (const Vec3f c : centers) inside |= length(p - c) < 0.4999f;
    if (!inside) hits.push_back({p, n, n, 0, 0, 0});
  }
  Object o{thin_hits(hits, std::vector<float>(hits.size(), kSpacing), kSpacing), {}};
  for (const Vec3f p : o.points.positions) {
    Rng rng(4, 0, o.colors.size());
    o.colors.push_back(color(p) + Vec3f{rng.normal(), rng.normal(), rng.normal()} * 0.02f);
  }
  return o;
}

SurfacePoint on_sphere(Vec3f center, Vec3f direction) {
  return {center + normalize(direction) * 0.5f, normalize(direction)};
}

std::vector<float> grown(const Object& o, const std::vector<SurfacePoint>& positive,
                         const std::vector<SurfacePoint>& negative) {
  return grow(o.points, o.colors, click_seeds(o.points, positive, negative));
}

// Share of the points farther than a spacing from the border that are on the right side of it. depth: into
// the part, negative outside.
double right_share(const Object& o, const std::vector<float>& scores,
                   const std::function<float(Vec3f)>& depth) {
  int right = 0, all = 0;
  for (size_t i = 0; i < scores.size(); ++i) {
    const float d = depth(o.points.positions[i]);
    if (std::abs(d) < kSpacing) continue;
    right += (scores[i] >= 0.5f) == (d > 0);
    ++all;
  }
  return double(right) / all;
}

constexpr Vec3f kOrigin{0, 0, 0};
float cap_depth(Vec3f p) { return p.z - 0.2f; }
Object capped_sphere() {
  return spheres(std::span(&kOrigin, 1), [](Vec3f p) {
    const bool nostril = length(p - Vec3f{0.1f, 0, 0.49f}) < 0.08f;
    return nostril ? kDark : p.z > 0.2f ? kPink : kWhite;
  });
}

TEST(Grow, TakesThePartThatItsColorEndsAndTheIslandInIt) {
  const Object o = capped_sphere();
  const auto scores = grown(o, {on_sphere(kOrigin, {-0.2f, 0, 1})}, {on_sphere(kOrigin, {1, 0, -0.2f})});
  EXPECT_GT(right_share(o, scores, cap_depth), 0.995);
}

TEST(Grow, NeedsNoNegativeClicks) {
  const Object o = capped_sphere();
  const auto scores = grown(o, {on_sphere(kOrigin, {-0.2f, 0, 1})}, {});
  EXPECT_GT(right_share(o, scores, cap_depth), 0.99);
}

// The white in between was not clicked; it is of the kind of neither, but the part ends where the pink does.
TEST(Grow, SelectsSeveralPiecesAndLeavesAlikeOnesAlone) {
  const auto depth = [](Vec3f p) { return std::abs(p.z) - 0.3f; };  // two pink caps
  const Object o = spheres(std::span(&kOrigin, 1), [&](Vec3f p) { return depth(p) > 0 ? kPink : kWhite; });
  const SurfacePoint top = on_sphere(kOrigin, {0, 0, 1}), bottom = on_sphere(kOrigin, {0.1f, 0, -1}),
                     belt = on_sphere(kOrigin, {1, 0, 0});
  EXPECT_GT(right_share(o, grown(o, {top, bottom}, {belt}), depth), 0.99);
  EXPECT_GT(right_share(o, grown(o, {top}, {belt}), [](Vec3f p) { return p.z - 0.3f; }), 0.99);
}

TEST(Grow, EndsAtACreaseWhereColorSaysNothing) {
  const Vec3f centers[] = {{0, 0, -0.4f}, {0, 0, 0.4f}};
  const Object o = spheres(centers, [](Vec3f) { return kWhite; });
  const auto scores = grown(o, {on_sphere(centers[1], {1, 0, 1})}, {on_sphere(centers[0], {1, 0, -1})});
  EXPECT_GT(right_share(o, scores, [](Vec3f p) { return p.z; }), 0.98);
}

TEST(Grow, SameBitsOnAnyNumberOfThreads) {
  const Object o = capped_sphere();
  const auto run = [&] {
    return grown(o, {on_sphere(kOrigin, {0, 0, 1})}, {on_sphere(kOrigin, {1, 0, -0.2f})});
  };
  const auto all = run();
  const auto one = Threads(1).run(run);
  EXPECT_EQ(all, one);
}

TEST(ClickSeeds, AreTheHandlerPointsAroundTheClick) {
  const Object o = capped_sphere();
  const SurfacePoint click = on_sphere(kOrigin, {0, 0, 1}), far = on_sphere(kOrigin, {0, 0, -1});
  const auto seeds = click_seeds(o.points, std::span(&click, 1), std::span(&far, 1));
  int positive = 0;
  for (size_t i = 0; i < seeds.size(); ++i) {
    const bool near = length(o.points.positions[i] - click.position) < 2 * kSpacing;
    EXPECT_EQ(seeds[i] == Seed::positive, near);
    positive += near;
  }
  EXPECT_GT(positive, 4);
}

TEST(ClickSeeds, ContradictingClicksAreAUsageError) {
  const Object o = capped_sphere();
  const SurfacePoint click = on_sphere(kOrigin, {0, 0, 1});
  try {
    click_seeds(o.points, std::span(&click, 1), std::span(&click, 1));
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::usage);
  }
}

TEST(PointGraph, JoinsNeighborsOnOneSide) {
  HandlerPoints points = capped_sphere().points;
  const size_t n = points.positions.size();
  for (size_t i = 0; i < n; ++i) {  // a second, inner side of the same sheet
    points.positions.push_back(points.positions[i] * 0.99f);
    points.normals.push_back(-points.normals[i]);
  }
  const PointGraph graph = point_graph(points, std::vector<Vec3f>(2 * n, kWhite));
  std::set<std::pair<uint32_t, uint32_t>> edges;
  for (const GraphEdge& e : graph.edges) {
    edges.insert({e.a, e.b});
    EXPECT_EQ(e.color, 0);
    EXPECT_NEAR(e.length, length(points.positions[e.a] - points.positions[e.b]) / kSpacing, 1e-4);
    EXPECT_EQ(e.crease > 0, e.a >= n) << "the inner side is hollow, the outer one bulges";
  }
  EXPECT_EQ(edges.size(), graph.edges.size());
  for (uint32_t a = 0; a < 2 * n; a += 7)
    for (uint32_t b = a + 1; b < 2 * n; ++b) {
      const float d = length(points.positions[a] - points.positions[b]) / kSpacing;
      if (std::abs(d - 2.5f) < 1e-3f) continue;
      EXPECT_EQ(edges.count({a, b}) == 1, d < 2.5f && dot(points.normals[a], points.normals[b]) > 0);
    }
}

TEST(PointGraph, OptionsWeighLightnessAndCreases) {
  const Vec3f centers[] = {{0, 0, 0}, {0.6f, 0, 0}};  // they meet in a crease
  const HandlerPoints points = spheres(centers, [](Vec3f) { return kWhite; }).points;
  std::vector<Vec3f> grays;
  for (const Vec3f p : points.positions) grays.push_back(Vec3f{1, 1, 1} * (p.y > 0 ? 0.6f : 0.1f));
  const PointGraph usual = point_graph(points, grays), twice = point_graph(points, grays, {0.8f, 0.06f}),
                   none = point_graph(points, grays, {0, 0});
  ASSERT_EQ(usual.edges.size(), twice.edges.size());
  float color = 0, crease = 0;
  for (size_t i = 0; i < usual.edges.size(); ++i) {
    const GraphEdge &a = usual.edges[i], &b = twice.edges[i], &c = none.edges[i];
    EXPECT_NEAR(b.color, 2 * a.color, 1e-5f);
    EXPECT_NEAR(b.crease, 2 * a.crease, 1e-5f);
    EXPECT_NEAR(c.color, 0, 1e-5f);  // grays have no hue
    EXPECT_EQ(c.crease, 0);
    color = max(color, a.color);
    crease = max(crease, a.crease);
  }
  EXPECT_GT(color, 0.1f);
  EXPECT_GT(crease, 0.01f);
}

// On a path of equal steps the probability is linear between the seeds.
TEST(RandomWalk, IsHarmonicBetweenSeeds) {
  constexpr int n = 41;
  PointGraph path;
  path.colors.assign(n, kWhite);
  for (uint32_t i = 0; i + 1 < n; ++i) path.edges.push_back({i, i + 1, 1, 0, 0});
  std::vector<Seed> seeds(n, Seed::none);
  seeds[0] = Seed::positive;
  seeds[n - 1] = Seed::negative;
  const auto scores = random_walk(path, seeds, std::vector<float>(n, 0.5f));
  for (int i = 0; i < n; ++i) EXPECT_NEAR(scores[i], 1 - double(i) / (n - 1), 5e-3);
}

TEST(RandomWalk, StopsInTheMiddleOfABorder) {
  constexpr int n = 41;
  PointGraph path;
  path.colors.assign(n, kWhite);
  for (uint32_t i = 0; i + 1 < n; ++i)  // a ramp of four equal steps about point 12
    path.edges.push_back({i, i + 1, 1, i >= 10 && i < 14 ? 0.05f : 0.001f, 0});
  std::vector<Seed> seeds(n, Seed::none);
  seeds[0] = Seed::positive;
  seeds[n - 1] = Seed::negative;
  const auto scores = random_walk(path, seeds, std::vector<float>(n, 0.5f));
  EXPECT_GT(scores[10], 0.9);
  EXPECT_NEAR(scores[12], 0.5, 0.05);
  EXPECT_LT(scores[14], 0.1);
}

}  // namespace
}  // namespace cei3d
