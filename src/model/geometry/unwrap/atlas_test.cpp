// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/atlas.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

// A ring around the z axis.
Mesh torus(int around, int across, float radius, float thickness) {
  Mesh m;
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const float a = 2 * kPi * float(i) / float(around), b = 2 * kPi * float(j) / float(across);
      const float r = radius + thickness * std::cos(b);
      m.positions.push_back({r * std::cos(a), r * std::sin(a), thickness * std::sin(b)});
      const auto id = [&](int p, int q) { return uint32_t(p % around * across + q % across); };
      m.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      m.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
  return m;
}

void add(Mesh& to, const Mesh& from, Vec3f shift) {
  const uint32_t first = uint32_t(to.positions.size());
  for (const Vec3f p : from.positions) to.positions.push_back(p + shift);
  for (const auto& [a, b, c] : from.triangles) to.triangles.push_back({first + a, first + b, first + c});
}

// Every corner of every triangle is the mesh's.
void expect_same_surface(const Mesh& mesh, const Atlas& atlas) {
  ASSERT_EQ(atlas.triangles.size(), mesh.triangles.size());
  for (size_t f = 0; f < mesh.triangles.size(); ++f)
    for (int k = 0; k < 3; ++k) ASSERT_EQ(atlas.vertex[atlas.triangles[f][k]], mesh.triangles[f][k]) << f;
}

struct Wanted {
  double used, stretch;
};

void expect_good(const Mesh& mesh, Wanted wanted, int texels = 1024) {
  const Atlas atlas = unwrap(mesh, texels);
  expect_same_surface(mesh, atlas);
  for (const Vec2f uv : atlas.uv) {
    EXPECT_GE(std::min(uv.x, uv.y), 0);
    EXPECT_LE(std::max(uv.x, uv.y), 1);
  }
  const AtlasQuality q = quality_of(mesh, atlas, texels);
  EXPECT_EQ(q.flipped, 0u);
  EXPECT_EQ(q.overlapping, 0u);
  EXPECT_GE(q.used, wanted.used);
  EXPECT_LE(q.stretch, wanted.stretch);
}

// A few round charts leave more room between them than many of all sizes do.
TEST(Atlas, Ball) { expect_good(sphere_mesh(1, 4), {0.6, 1.15}); }
TEST(Atlas, Box) { expect_good(box_mesh(20, 10, 5, 0.1f), {0.65, 1.0001}); }
TEST(Atlas, Ring) { expect_good(torus(80, 30, 1, 0.3f), {0.6, 1.15}); }
TEST(Atlas, OpenSheet) { expect_good(plane_mesh(40, 20, 0.1f), {0.3, 1.0001}); }

// 40 s of one core: cei3d_model_geometry_test --gtest_also_run_disabled_tests --gtest_filter=Atlas.*Million*
TEST(Atlas, DISABLED_AMillionFacesWithBumps) {
  Mesh m = torus(1000, 500, 1, 0.3f);
  for (Vec3f& p : m.positions)
    p = p * (1 + 0.02f * std::sin(30 * p.x) * std::sin(25 * p.y) * std::sin(20 * p.z));
  expect_good(m, {0.6, 1.15}, 4096);
}

TEST(Atlas, TwoComponentsOfDifferentSize) {
  Mesh m = sphere_mesh(1, 4);
  add(m, box_mesh(3, 3, 3, 0.02f), {3, 0, 0});
  expect_good(m, {0.6, 1.15});
}

TEST(Atlas, SliversAndHoles) {
  Mesh m = torus(400, 8, 1, 0.3f);  // triangles 15 times as long as wide
  std::vector<std::array<uint32_t, 3>> kept;
  for (size_t f = 0; f < m.triangles.size(); ++f)
    if (f % 97 > 3) kept.push_back(m.triangles[f]);
  m.triangles = kept;
  for (size_t v = 0; v < m.positions.size(); v += 5)  // needles: neighbors nearly meet
    m.positions[v] = m.positions[v] * 0.001f + m.positions[(v + 8) % m.positions.size()] * 0.999f;
  expect_good(m, {0.5, 1.3});
}

// Faces of less than a texel, whose folds are thinner than that.
TEST(Atlas, ACrumpledBallInASmallTexture) {
  Mesh m = sphere_mesh(1, 5);
  for (size_t v = 0; v < m.positions.size(); ++v)
    m.positions[v] = m.positions[v] * (1 + 0.06f * std::sin(float(v) * 1.7f));
  const Atlas atlas = unwrap(m, 128);
  const AtlasQuality q = quality_of(m, atlas, 128);
  EXPECT_EQ(q.flipped, 0u);
  EXPECT_EQ(q.overlapping, 0u);
}

TEST(Atlas, ManyFacesAtOneEdgeAndTwistedOnes) {
  Mesh m;
  m.positions = {{0, 0, 0}, {0, 0, 1}};
  for (int i = 0; i < 7; ++i) {
    const float a = float(i) * 0.9f;
    m.positions.push_back({std::cos(a), std::sin(a), 0.5f});
    m.triangles.push_back({0, 1, uint32_t(i + 2)});
    if (i % 2) std::swap(m.triangles.back()[0], m.triangles.back()[1]);
  }
  m.triangles.push_back({2, 3, 3});  // no area
  expect_good(m, {0.3, 1.0001});
}

// A ball of three caps is the fewest that lie nearly flat; a box may be unfolded.
TEST(Atlas, SmoothSurfacesHaveFewCharts) {
  EXPECT_LE(unwrap(sphere_mesh(1, 5), 512).charts, 8u);
  EXPECT_LE(unwrap(box_mesh(20, 10, 5, 0.1f), 512).charts, 6u);
}

TEST(Atlas, TheSameBitsEveryTime) {
  const Mesh m = torus(30, 10, 1, 0.4f);
  const Atlas a = unwrap(m, 256), b = unwrap(m, 256);
  ASSERT_EQ(a.uv.size(), b.uv.size());
  for (size_t v = 0; v < a.uv.size(); ++v) {
    EXPECT_EQ(a.uv[v].x, b.uv[v].x);
    EXPECT_EQ(a.uv[v].y, b.uv[v].y);
  }
}

TEST(Atlas, NothingToLayATextureOnIsAnError) {
  EXPECT_THROW(unwrap(Mesh(), 512), Error);
  Mesh line;
  line.positions = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  line.triangles = {{0, 1, 2}};
  EXPECT_THROW(unwrap(line, 512), Error);
}

}  // namespace
}  // namespace cei3d
