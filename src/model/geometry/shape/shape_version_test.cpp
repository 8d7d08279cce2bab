// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/shape/shape_version.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/rng.h"
#include "model/geometry/shape/carry.h"

namespace cei3d {
namespace {

constexpr int kSide = 20;

// A square of the plane z = 0, [-1, 1]^2.
Mesh plate() {
  Mesh m;
  for (int y = 0; y <= kSide; ++y)
    for (int x = 0; x <= kSide; ++x) m.positions.push_back({2.0f * x / kSide - 1, 2.0f * y / kSide - 1, 0});
  m.normals.assign(m.positions.size(), {0, 0, 1});
  for (uint32_t y = 0; y < kSide; ++y)
    for (uint32_t x = 0; x < kSide; ++x) {
      const uint32_t a = y * (kSide + 1) + x, b = a + kSide + 1;
      m.triangles.push_back({a, a + 1, b + 1});
      m.triangles.push_back({a, b + 1, b});
    }
  return m;
}

// The vertices of the plate with x > 0 turned about the y axis and lifted: an affine map of half the plate.
struct Bend {
  Mat3f turn;
  Vec3f lift;
  Vec3f operator()(Vec3f p) const { return turn * p + lift; }
};
Bend bend(float angle, float lift) {
  return {{{{std::cos(angle), 0, std::sin(angle)}, {0, 1, 0}, {-std::sin(angle), 0, std::cos(angle)}}},
          {0, 0, lift}};
}

Reshape bending(const Mesh& mesh, const Bend& b) {
  Reshape r;
  const std::vector<Vec3f> flat = plate().positions;  // mesh may have more
  for (uint32_t v = 0; v < flat.size(); ++v) {
    if (flat[v].x <= 0.01f) continue;
    r.moved.push_back(v);
    r.positions.push_back(b(mesh.positions[v]));
    r.normals.push_back(b.turn * mesh.normals[v]);
    const Vec3f* m = b.turn.row;
    r.gradients.push_back({m[0].x, m[0].y, m[0].z, m[1].x, m[1].y, m[1].z, m[2].x, m[2].y, m[2].z});
  }
  return r;
}

// A triangle over the middle of the plate, two of whose corners are old.
Reshape patch(const Mesh& mesh) {
  Reshape r;
  r.removed = {3};
  r.added_positions = {{0, 0, 0.5f}};
  r.added_normals = {{0, 1, 0}};
  r.added_colors = {{1, 0, 0}};
  r.rim = {0, 5};
  r.rim_colors = {{0, 1, 0}, {0, 0, 1}};
  r.added_triangles = {{0, 5, uint32_t(mesh.positions.size())}};
  return r;
}

// A hit of the present mesh, somewhat off it.
Hit random_hit(const Mesh& mesh, uint64_t i) {
  Rng rng(4, 0, i);
  const uint32_t t = rng.below(uint32_t(mesh.triangles.size()));
  float b1 = rng.uniform(), b2 = rng.uniform();
  if (b1 + b2 > 1) b1 = 1 - b1, b2 = 1 - b2;
  const auto& c = mesh.triangles[t];
  const Vec3f n = normalize(mesh.normals[c[0]]);
  const Vec3f p =
      mesh.positions[c[0]] * (1 - b1 - b2) + mesh.positions[c[1]] * b1 + mesh.positions[c[2]] * b2;
  return {p + n * (0.01f * rng.uniform()), n, n, t, b1, b2};
}

void expect_near(Vec3f a, Vec3f b, float tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance);
}

TEST(ShapeVersions, AHitIsWhereItsMatterWas) {
  auto flat = std::make_shared<const Surface>(plate());
  const Bend first = bend(0.7f, 0.1f), second = bend(-1.9f, 0.2f);
  ShapeVersions versions = with_version({}, flat, bending(flat->mesh(), first));
  versions =
      with_version(versions, versions.back()->surface, bending(versions.back()->surface->mesh(), second));
  int moved = 0;
  for (uint64_t i = 0; i < 500; ++i) {
    // A hit of the plate, brought to the last version by the maps themselves where its whole triangle moved.
    const Hit rest = random_hit(flat->mesh(), i);
    const auto& c = flat->mesh().triangles[rest.triangle];
    int right = 0;
    for (const uint32_t v : c) right += flat->mesh().positions[v].x > 0.01f;
    if (right == 0) {
      const SurfacePoint p = in_version(versions, rest, 0);
      EXPECT_TRUE(p.position.x == rest.position.x && p.position.z == rest.position.z &&
                  p.normal.z == rest.normal.z);
    }
    if (right < 3) continue;
    ++moved;
    Hit now = rest, between = rest;
    between.position = first(rest.position), between.normal = first.turn * rest.normal;
    now.position = second(between.position), now.normal = second.turn * between.normal;
    expect_near(in_version(versions, now, 0).position, rest.position, 1e-5f);
    expect_near(in_version(versions, now, 0).normal, rest.normal, 1e-5f);
    expect_near(in_version(versions, now, 1).position, between.position, 1e-5f);
    expect_near(in_version(versions, now, 1).normal, between.normal, 1e-5f);
    expect_near(in_version(versions, now, 2).position, now.position, 0);
  }
  EXPECT_GT(moved, 100);
}

TEST(ShapeVersions, NormalsTurnByTheInverseTranspose) {  // a shear: points and normals go different ways
  auto flat = std::make_shared<const Surface>(plate());
  const Mat3f shear{{{1, 0, 0}, {0, 1, 0}, {0.5f, 0, 1}}};  // z += x / 2
  Reshape r = bending(flat->mesh(), {shear, {0, 0, 0}});
  const ShapeVersions versions = with_version({}, flat, r);
  Hit hit = random_hit(flat->mesh(), 0);
  for (uint64_t i = 1;
       in_version(versions, hit, 0).position.x < 0.2f || versions.back()->shaped_in(hit.triangle) == 0; ++i)
    hit = random_hit(flat->mesh(), i);
  hit.position = shear * hit.position;
  hit.normal = normalize(Vec3f{-0.5f, 0, 1});  // of the plane z = x / 2
  expect_near(in_version(versions, hit, 0).normal, {0, 0, 1}, 1e-5f);
}

TEST(ShapeVersions, TrianglesAreFollowed) {
  auto flat = std::make_shared<const Surface>(plate());
  ShapeVersions versions = with_version({}, flat, patch(flat->mesh()));
  versions = with_version(versions, versions.back()->surface,
                          bending(versions.back()->surface->mesh(), bend(0.3f, 0)));
  const ShapeVersion &one = *versions[1], &two = *versions[2];
  const size_t n = flat->mesh().triangles.size();  // one was removed, one added
  ASSERT_EQ(one.born.size(), n);
  EXPECT_EQ(one.born_in(0), 0);
  EXPECT_EQ(one.born_in(uint32_t(n - 1)), 1);
  EXPECT_EQ(two.born_in(uint32_t(n - 1)), 1);
  EXPECT_EQ(one.before[3], 4u);
  for (uint32_t t = 0; t < n; ++t) {
    bool moved = false;
    for (const uint32_t v : two.surface->mesh().triangles[t])
      moved |= v < plate().positions.size() && plate().positions[v].x > 0.01f;
    EXPECT_EQ(two.shaped_in(t), moved ? 2 : t == n - 1 ? 1 : 0);
  }
  expect_near(two.colors[5], {0, 0, 1}, 0);
  expect_near(two.colors.back(), {1, 0, 0}, 0);
}

TEST(ShapeVersions, WhatStaysKeepsWhatItSaw) {
  auto flat = std::make_shared<const Surface>(plate());
  // Right half upright.
  const ShapeVersions versions = with_version({}, flat, bending(flat->mesh(), bend(-1.2f, 0)));
  const Surface& bent = *versions[1]->surface;
  const Surface anew{Mesh(bent.mesh())};
  size_t kept_differs = 0;
  for (uint32_t v = 0; v < plate().positions.size(); ++v)
    for (int k = 0; k < kSkyDirections; ++k) {
      if (plate().positions[v].x > 0.01f)
        ASSERT_EQ(bent.sees(v, k), anew.sees(v, k));
      else
        ASSERT_EQ(bent.sees(v, k), flat->sees(v, k));
      kept_differs += bent.sees(v, k) != anew.sees(v, k);
    }
  EXPECT_GT(kept_differs, 1000u);  // else the test says nothing
}

TEST(Carry, HandlerPointsFollowTheirMatter) {
  const Mesh flat = plate();
  HandlerPoints points;
  points.spacing = 0.05f;
  for (uint64_t i = 0; i < 300; ++i) {
    const Hit h = random_hit(flat, i);
    points.positions.push_back(h.position);
    points.normals.push_back(h.normal);
    points.footprints.push_back(0.01f);
  }
  const Bend b = bend(0.6f, 0.1f);
  const Reshape r = bending(flat, b);
  const HandlerPoints moved = carried(points, flat, apply(flat, r), r);
  ASSERT_EQ(moved.positions.size(), points.positions.size());
  for (size_t i = 0; i < 300; ++i) {
    if (std::abs(points.positions[i].x) < 0.11f) continue;  // beside the fold either vertex is right
    const bool right = points.positions[i].x > 0;
    expect_near(moved.positions[i], right ? b(points.positions[i]) : points.positions[i], 1e-5f);
    expect_near(moved.normals[i], right ? b.turn * points.normals[i] : points.normals[i], 1e-5f);
  }
}

TEST(Carry, HandlerPointsGoWithWhatIsRemovedAndComeWithNewMatter) {
  const Mesh flat = plate();
  HandlerPoints points;
  points.spacing = 0.05f;
  points.positions = {{-0.95f, -0.95f, 0}, {0.95f, 0.95f, 0}};
  points.normals.assign(2, {0, 0, 1});
  points.footprints.assign(2, 0.01f);
  Reshape r = patch(flat);
  r.removed.clear();
  for (uint32_t t = 0; t < flat.triangles.size(); ++t)
    if (flat.positions[flat.triangles[t][0]].x > 0.5f) r.removed.push_back(t);
  const HandlerPoints left = carried(points, flat, apply(flat, r), r);
  ASSERT_EQ(left.positions.size(), 2u);
  expect_near(left.positions[0], points.positions[0], 0);
  expect_near(left.positions[1], {0, 0, 0.5f}, 0);
}

}  // namespace
}  // namespace cei3d
