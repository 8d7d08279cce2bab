// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

// Latitude-longitude sphere around `center`.
Mesh sphere(Vec3f center, float radius, int n = 40) {
  Mesh m;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      const float t = kPi * float(i) / float(n), p = kPi * float(j) / float(n);
      m.positions.push_back(center + radius * Vec3f{sin(t) * cos(p), sin(t) * sin(p), cos(t)});
    }
  const auto at = [&](int i, int j) { return uint32_t(i * 2 * n + j % (2 * n)); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) {
      m.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return m;
}

Mesh join(Mesh a, const Mesh& b) {
  const uint32_t n = uint32_t(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (auto t : b.triangles) a.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  return a;
}

TEST(Surface, AConvexBodySeesExactlyItsOwnHemisphere) {
  const Surface s(sphere({0, 0, 0}, 0.8f));
  int wrong = 0, total = 0;
  for (uint32_t v = 0; v < s.mesh().positions.size(); v += 7)
    for (int k = 0; k < kSkyDirections; ++k) {
      const float c = dot(normalize(s.mesh().positions[v]), sky_directions()[k]);
      if (std::abs(c) < 0.06f) continue;  // facets
      ++total;
      wrong += s.sees(v, k) != (c > 0);
    }
  EXPECT_GT(total, 100000);
  EXPECT_EQ(wrong, 0);
}

TEST(Surface, ANeighborHidesItsSolidAngle) {
  // From the top of the unit-less small sphere at the origin, a sphere of radius .3 at height .8 covers a
  // cone of half-angle asin(.3 / .7).
  const Surface s(join(sphere({0, 0, 0}, 0.1f), sphere({0, 0, 0.8f}, 0.3f)));
  const uint32_t top = 0;
  ASSERT_GT(s.mesh().positions[top].z, 0.0999f);
  for (int k = 0; k < kSkyDirections; ++k) {
    const Vec3f d = sky_directions()[k];
    const float angle = std::acos(d.z), edge = std::asin(0.3f / 0.7f);
    if (d.z < 0.1f || std::abs(angle - edge) < 0.03f) continue;
    EXPECT_EQ(s.sees(top, k), angle > edge) << d.x << ' ' << d.y << ' ' << d.z;
  }
}

TEST(Surface, NothingIsInTheWayWhereItSaysOpen) {
  const Surface s(join(sphere({0, 0, -0.35f}, 0.5f), sphere({0, 0, 0.5f}, 0.3f)));
  int open = 0, open_but_met = 0, free = 0;
  for (uint64_t i = 0; i < 20000; ++i) {
    Rng rng(4, 0, i);
    const uint32_t f = rng.below(uint32_t(s.mesh().triangles.size()));
    const auto& t = s.mesh().triangles[f];
    const Vec3f normal = at_corners(s.mesh().normals, t, 1.0f / 3, 1.0f / 3);
    const Vec3f from = at_corners(s.mesh().positions, t, 1.0f / 3, 1.0f / 3) + normalize(normal) * 2e-3f;
    const Vec3f to = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
    Surface::RayHit met;
    s.intersect(std::span(&from, 1), std::span(&to, 1), 0, std::span(&met, 1));
    free += met.t < 0;
    if (!s.sees_around(f, to)) continue;
    ++open;
    open_but_met += met.t >= 0;
  }
  EXPECT_GT(open, free * 2 / 3);  // the rest is near an edge
  EXPECT_LT(open_but_met, open / 500);
}

TEST(Surface, ClosestHitsOnASphereAreAnalytic) {
  const Surface s(sphere({0, 0, 0}, 0.8f, 100));
  std::vector<Vec3f> o{{0, 0.013f, 2}, {3, 0, 2}, {0, 0.2f, 0}}, d{{0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
  std::vector<Surface::RayHit> h(3);
  s.intersect(o, d, 1e-4f, h);
  EXPECT_NEAR(h[0].t, 2 - std::sqrt(0.64f - 0.013f * 0.013f), 1e-3);
  EXPECT_LT(h[1].t, 0);
  EXPECT_NEAR(h[2].t, 0.6f, 1e-3);
  const auto& t = s.mesh().triangles[h[0].triangle];
  const auto& p = s.mesh().positions;
  const Vec3f q = p[t[0]] * (1 - h[0].b1 - h[0].b2) + p[t[1]] * h[0].b1 + p[t[2]] * h[0].b2;
  EXPECT_NEAR(length(q - (o[0] + d[0] * h[0].t)), 0, 1e-5);
}

TEST(Surface, AStoredTableIsTheSameSurface) {
  const Surface a(sphere({0, 0, 0}, 0.8f));
  const Surface b(a.mesh(), a.visibility());
  EXPECT_EQ(a.visibility(), b.visibility());
  EXPECT_THROW(Surface(a.mesh(), std::vector<uint8_t>(3)), Error);
  Mesh broken = a.mesh();
  broken.triangles[5][1] = 1u << 30;
  EXPECT_THROW(Surface{broken}, Error);
}

}  // namespace
}  // namespace cei3d
