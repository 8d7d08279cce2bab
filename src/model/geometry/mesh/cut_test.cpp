// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/cut.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "core/base/error.h"
#include "core/math/rng.h"
#include "model/geometry/mesh/patch.h"
#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

const Vec3f kGray{0.5f, 0.5f, 0.5f};

template <class F>
CutResult cut_where(const Mesh& mesh, F in_part) {
  std::vector<uint8_t> labels;
  for (const Vec3f p : mesh.positions) labels.push_back(in_part(p));
  return cut(mesh, labels, std::vector<Vec3f>(mesh.positions.size(), kGray));
}

using Edges = std::map<std::pair<uint32_t, uint32_t>, int>;
Edges directed_edges(const std::vector<std::array<uint32_t, 3>>& triangles) {
  Edges edges;
  for (const auto& t : triangles)
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  return edges;
}

// Every edge has one triangle on each side, wound alike.
bool is_closed_manifold(const Mesh& m) {
  const Edges edges = directed_edges(m.triangles);
  for (const auto& [e, n] : edges)
    if (n != 1 || !edges.count({e.second, e.first})) return false;
  return true;
}

int euler_characteristic(const Mesh& m) {
  std::set<uint32_t> used;
  for (const auto& t : m.triangles) used.insert(t.begin(), t.end());
  return int(used.size()) - int(directed_edges(m.triangles).size()) / 2 + int(m.triangles.size());
}

double volume(const Mesh& m) {
  double v = 0;
  for (const auto& t : m.triangles)
    v +=
        dot(to_double(m.positions[t[0]]), cross(to_double(m.positions[t[1]]), to_double(m.positions[t[2]]))) /
        6;
  return v;
}

double area(std::span<const Vec3f> p, std::span<const std::array<uint32_t, 3>> triangles) {
  double a = 0;
  for (const auto& t : triangles) a += 0.5 * double(length(cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]])));
  return a;
}

bool never(uint32_t, uint32_t) { return false; }

TEST(LoopTriangles, APlanePolygonOfAnyShapeIsCoveredExactly) {
  // A U of 600 corners: a triangulation that left the polygon would be larger.
  std::vector<Vec3f> u;
  const Vec3f corners[] = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {2, 3, 0},
                           {2, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 75; ++k)
      u.push_back(corners[i] + (corners[(i + 1) % 8] - corners[i]) * (float(k) / 75));
  const auto triangles = triangulate_loop(u, never);
  EXPECT_EQ(triangles.size(), u.size() - 2);
  EXPECT_NEAR(area(u, triangles), 7, 1e-4);
  for (const auto& t : triangles) EXPECT_GE(cross(u[t[1]] - u[t[0]], u[t[2]] - u[t[0]]).z, -1e-6f);
}

TEST(LoopTriangles, DiagonalsThatAreTakenAreAvoided) {
  const std::vector<Vec3f> square{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.1f}, {0, 1, 0}};
  for (const uint32_t first : {0u, 1u}) {
    const auto taken = [&](uint32_t a, uint32_t b) {
      return std::min(a, b) == first && std::max(a, b) == first + 2;
    };
    const Edges edges = directed_edges(triangulate_loop(square, taken));
    EXPECT_FALSE(edges.count({first, first + 2}));
    EXPECT_TRUE(edges.count({1 - first, 3 - first}));
  }
}

TEST(Patch, IsAsFineAsItsLoopAndCoversIt) {
  std::vector<Vec3f> circle;
  for (int i = 0; i < 120; ++i) circle.push_back({cos(2 * kPi * i / 120.0f), sin(2 * kPi * i / 120.0f), 0});
  const Patch p = fill_loop(circle, never);
  EXPECT_NEAR(area(p.positions, p.triangles), 60 * std::sin(2 * kPi / 120), 1e-4);
  for (const auto& [e, n] : directed_edges(p.triangles)) {
    EXPECT_EQ(n, 1);
    const float edge = length(p.positions[e.first] - p.positions[e.second]);
    EXPECT_LT(edge, 0.12f);
    EXPECT_GT(edge, 0.0175f);  // a third of a side
  }
}

TEST(Cut, AHoleInAPlaneIsClosedByThePlane) {
  // A hill on the plane is cut off.
  Mesh m = plane_mesh(60, 60, 0.02f);
  const Vec3f top{0.6f, 0.6f, 0};
  for (Vec3f& p : m.positions) {
    const float d = length(p - top);
    if (d < 0.25f) p.z = square(1 - square(d / 0.25f));
  }
  const CutResult r = cut_where(m, [&](Vec3f p) { return std::hypot(p.x - 0.6f, p.y - 0.6f) < 0.33f; });
  ASSERT_GT(r.reshape.added_positions.size(), 500u);
  for (const Vec3f p : r.reshape.added_positions) EXPECT_NEAR(p.z, 0, 1e-5);
  for (const Vec3f n : r.reshape.added_normals) EXPECT_GT(n.z, 0.999f);
  const Mesh after = apply(m, r.reshape);
  EXPECT_NEAR(area(after.positions, after.triangles), 1.44, 1e-3);
  EXPECT_EQ(r.report.holes, 1u);
}

TEST(Cut, ASphereWithoutItsCapIsClosedAndAlmostASphere) {
  const Mesh m = sphere_mesh(0.7f, 5);
  const CutResult r = cut_where(m, [](Vec3f p) { return p.z > 0.35f; });
  const Mesh after = apply(m, r.reshape);
  EXPECT_TRUE(is_closed_manifold(after));
  EXPECT_EQ(euler_characteristic(after), 2);
  const double h = 0.35, cap = kPi * h * h * (3 * 0.7 - h) / 3, all = volume(m);
  EXPECT_GT(volume(after), all - cap);  // carrying on the tangents gives a dome, not a flat cut
  EXPECT_LT(volume(after), all);
  for (size_t i = 0; i < r.reshape.added_positions.size(); ++i) {
    const Vec3f p = r.reshape.added_positions[i];
    EXPECT_GT(p.z, 0.3f);
    EXPECT_LT(length(p), 0.72f);
    EXPECT_GT(dot(r.reshape.added_normals[i], normalize(p)), 0.8f);
    EXPECT_LT(length(r.reshape.added_colors[i] - kGray), 1e-5f);
  }
}

TEST(Cut, TheOutlineOfThePatchMeetsTheNormalsAround) {
  const Mesh m = sphere_mesh(0.7f, 5);
  const CutResult r = cut_where(m, [](Vec3f p) { return p.z > 0.55f; });
  // New vertices next to old ones turn by the sphere's 0.05 an edge and some; a flat lid would turn by 0.66.
  for (const auto& t : r.reshape.added_triangles)
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = t[k], b = t[(k + 1) % 3];
      if (a >= m.positions.size() || b < m.positions.size()) continue;
      EXPECT_GT(dot(m.normals[a], r.reshape.added_normals[b - m.positions.size()]), std::cos(0.27f));
    }
}

TEST(Cut, WhatItLeavesIsUntouched) {
  const Mesh m = sphere_mesh(0.7f, 4);
  const Mesh after = apply(m, cut_where(m, [](Vec3f p) { return p.z > 0.35f; }).reshape);
  for (size_t v = 0; v < m.positions.size(); ++v) EXPECT_EQ(length(after.positions[v] - m.positions[v]), 0);
  const Edges edges = directed_edges(after.triangles);
  for (const auto& t : m.triangles)
    if (m.positions[t[0]].z < 0.2f) {
      EXPECT_TRUE(edges.count({t[0], t[1]}));
    }
}

TEST(Cut, AMiddlePieceLeavesTwoClosedOnes) {
  const Mesh m = box_mesh(60, 10, 10, 0.02f);
  Mesh with_normals = m;
  with_normals.normals.assign(m.positions.size(), Vec3f{0, 0, 1});
  const CutResult r = cut_where(with_normals, [](Vec3f p) { return p.x > 0.45f && p.x < 0.75f; });
  const Mesh after = apply(with_normals, r.reshape);
  EXPECT_TRUE(is_closed_manifold(after));
  EXPECT_EQ(r.report.pieces, 2u);
  EXPECT_EQ(r.report.holes, 2u);
  EXPECT_EQ(euler_characteristic(after), 4);
}

TEST(Cut, RaggedAndBranchedLabelsLeaveNoOpenEdge) {
  const Mesh m = sphere_mesh(0.7f, 5);
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    Rng rng(seed, 0, 0);
    std::vector<uint8_t> labels;
    for (const Vec3f p : m.positions) {
      const bool star = p.z > 0.7f * (0.3f + 0.25f * std::sin(5 * std::atan2(p.y, p.x)));
      labels.push_back(rng.uniform() < 0.2f ? !star : star);
    }
    const CutResult r = cut(m, labels, std::vector<Vec3f>(m.positions.size(), kGray));
    EXPECT_TRUE(is_closed_manifold(apply(m, r.reshape))) << seed;
    EXPECT_EQ(r.report.holes, 1u) << seed;
  }
}

TEST(Cut, RawNoiseLeavesNoOpenEdge) {
  const Mesh m = sphere_mesh(0.7f, 4);
  for (uint64_t seed = 1; seed <= 8; ++seed) {
    Rng rng(seed, 0, 0);
    std::vector<uint8_t> labels;
    for (size_t v = 0; v < m.positions.size(); ++v) labels.push_back(rng.uniform() < 0.3f);
    EXPECT_TRUE(
        is_closed_manifold(apply(m, cut(m, labels, std::vector<Vec3f>(labels.size(), kGray)).reshape)));
  }
}

TEST(Cut, IslandsGoWithTheirSurroundings) {
  const Mesh m = sphere_mesh(0.7f, 5);
  const Vec3f speck = normalize(Vec3f{0.3f, 0.2f, 0.9f}) * 0.7f,
              far = normalize(Vec3f{0.3f, 0.2f, -0.9f}) * 0.7f;
  const CutResult r = cut_where(
      m, [&](Vec3f p) { return (p.z > 0.2f && length(p - speck) > 0.06f) || length(p - far) < 0.06f; });
  EXPECT_EQ(r.report.holes, 1u);
  EXPECT_EQ(r.report.pieces, 1u);
}

TEST(Cut, ColorIsThatOfTheSurroundings) {
  const Mesh m = sphere_mesh(0.7f, 5);
  std::vector<uint8_t> labels;
  std::vector<Vec3f> colors;
  for (const Vec3f p : m.positions) {
    labels.push_back(p.z > 0.4f);
    colors.push_back(p.z > 0.385f ? Vec3f{1, 0, 0} : p.x > 0 ? Vec3f{0, 0.2f, 0.8f} : Vec3f{0, 0.8f, 0.2f});
  }
  const Reshape r = cut(m, labels, colors).reshape;
  for (size_t i = 0; i < r.added_colors.size(); ++i) {
    const Vec3f c = r.added_colors[i];
    EXPECT_LT(c.x, 0.05f);
    EXPECT_NEAR(c.y + c.z, 1, 0.06f);
    if (r.added_positions[i].x > 0.35f) {
      EXPECT_GT(c.z, 0.6f);
    }
  }
}

TEST(Cut, NothingAndEverythingAreErrors) {
  const Mesh m = sphere_mesh(0.7f, 3);
  EXPECT_THROW(cut_where(m, [](Vec3f) { return false; }), Error);
  EXPECT_THROW(cut_where(m, [](Vec3f) { return true; }), Error);
}

}  // namespace
}  // namespace cei3d
