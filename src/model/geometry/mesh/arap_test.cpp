// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/arap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/parallel.h"
#include "core/math/rng.h"
#include "model/geometry/mesh/rotation.h"
#include "model/geometry/mesh/surface_gradient.h"
#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

Mat3d turn(Vec3d axis, double angle) {
  const Vec3d a = normalize(axis);
  const double c = std::cos(angle), s = std::sin(angle);
  const Mat3d cross_a{{{0, -a.z, a.y}, {a.z, 0, -a.x}, {-a.y, a.x, 0}}};
  Mat3d r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r.row[i][j] = (i == j ? c : 0) + s * cross_a.row[i][j] + (1 - c) * a[i] * a[j];
  return r;
}

double trace_product(const Mat3d& a, const Mat3d& b) {
  return dot(a.row[0], b.row[0]) + dot(a.row[1], b.row[1]) + dot(a.row[2], b.row[2]);
}

bool same_bits(Vec3f a, Vec3f b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// A plane dragged up at its middle; its rim is fixed.
struct Tent {
  Mesh mesh = plane_mesh(24, 24, 0.05f);
  ArapConstraints constraints;
  static constexpr uint32_t kTip = 25 * 12 + 12;

  explicit Tent(Vec3f drag) {
    for (const Vec3f p : mesh.positions) constraints.free.push_back(length(p - mesh.positions[kTip]) < 0.5f);
    constraints.free[kTip] = 0;
    constraints.handles = {kTip};
    constraints.targets = {mesh.positions[kTip] + drag};
  }
  ArapResult solve(float bending_length = 0.1f) const {
    return arap_deform(mesh.positions, mesh.triangles, constraints, {bending_length});
  }
};

TEST(Rotation, IsNearerThanAnyOther) {
  Rng rng(7, 0, 0);
  const auto value = [&] { return 2.0 * rng.uniform() - 1; };
  for (int round = 0; round < 50; ++round) {
    const Mat3d m{{{value(), value(), value()}, {value(), value(), value()}, {value(), value(), value()}}};
    const Mat3d best = nearest_rotation(m);
    EXPECT_NEAR(trace_product(best * transpose(best), Mat3d::identity()), 3, 1e-12);
    EXPECT_NEAR(dot(best.row[0], cross(best.row[1], best.row[2])), 1, 1e-12);
    for (int i = 0; i < 20; ++i) {
      const Mat3d other = turn({value(), value(), value()}, 3 * value()) * best;
      EXPECT_LE(trace_product(other, m), trace_product(best, m) + 1e-12);
    }
  }
}

TEST(Rotation, OfARotationIsItself) {
  const Mat3d r = turn({1, -2, 0.5}, 2.9);
  EXPECT_NEAR(trace_product(nearest_rotation(r), r), 3, 1e-12);
  EXPECT_NEAR(trace_product(nearest_rotation(Mat3d{}), Mat3d::identity()), 3, 1e-12);
}

TEST(Arap, EnergyNeverRises) {
  for (const float bending : {0.0f, 0.03f, 0.3f}) {
    const Tent tent({0.3f, 0.1f, 0.4f});
    const ArapResult r =
        arap_deform(tent.mesh.positions, tent.mesh.triangles, tent.constraints, {bending, 30, -1});
    ASSERT_EQ(r.energies.size(), 30u);
    for (size_t i = 1; i < r.energies.size(); ++i) EXPECT_LE(r.energies[i], r.energies[i - 1] * (1 + 1e-12));
    EXPECT_LT(r.energies.back(), 0.999 * r.energies.front());
  }
}

TEST(Arap, HandlesArriveAndTheRestStaysBitForBit) {
  const Tent tent({0.1f, 0, 0.2f});
  const ArapResult r = tent.solve();
  EXPECT_TRUE(same_bits(r.positions[Tent::kTip], tent.constraints.targets[0]));
  int moved = 0;
  for (uint32_t v = 0; v < r.positions.size(); ++v) {
    const bool same = same_bits(r.positions[v], tent.mesh.positions[v]);
    if (!tent.constraints.free[v] && v != Tent::kTip) {
      EXPECT_TRUE(same) << v;
    }
    moved += !same;
  }
  EXPECT_GT(moved, 200);
}

TEST(Arap, NoDragMovesNothing) {
  const Tent tent({0, 0, 0});
  const ArapResult r = tent.solve();
  for (size_t v = 0; v < r.positions.size(); ++v)
    EXPECT_LT(length(r.positions[v] - tent.mesh.positions[v]), 1e-6f);
}

TEST(Arap, BendingResistanceTurnsASpikeIntoAHill) {
  // Height lost on the first edge from the tip, as a share of the tip's height: a clamped plate loses
  // (d / R)^2 (1 + 2 ln (R / d)) = 0.056 at a tenth of the radius [Timoshenko].
  const auto first_step = [](float bending, float height) {
    const auto p = Tent({0, 0, height}).solve(bending).positions;
    return 1 - p[Tent::kTip + 1].z / p[Tent::kTip].z;
  };
  EXPECT_GT(first_step(0, 0.4f), 0.15f);
  EXPECT_NEAR(first_step(100, 0.4f), 0.056f, 0.006f);
}

TEST(Arap, RigidMotionOfTheHandlesIsRigidMotionOfAll) {
  const Mesh bar = box_mesh(20, 4, 4, 0.05f);
  const Mat3d r = turn({1, 2, 3}, 0.7);
  const auto moved = [&](Vec3f p) { return to_float(r * to_double(p) + Vec3d{0.1, -0.2, 0.05}); };
  ArapConstraints c;
  c.free.assign(bar.positions.size(), 1);
  for (uint32_t v = 0; v < bar.positions.size(); ++v)
    if (bar.positions[v].x < 0.11f || bar.positions[v].x > 0.89f) {
      c.free[v] = 0;
      c.handles.push_back(v);
      c.targets.push_back(moved(bar.positions[v]));
    }
  const ArapResult result = arap_deform(bar.positions, bar.triangles, c, {0.05f, 400, 1e-7});
  for (size_t v = 0; v < bar.positions.size(); ++v)
    EXPECT_LT(length(result.positions[v] - moved(bar.positions[v])), 2e-4f) << v;
}

// A bar of length 2 whose last quarter is rotated by 90 degrees around the center of an arc that keeps its
// length.
struct BentBar {
  Mesh bar = box_mesh(40, 4, 4, 0.05f);
  ArapConstraints constraints;

  BentBar() {
    const float arc = 1.0f, radius = arc / (0.5f * kPi);
    for (uint32_t v = 0; v < bar.positions.size(); ++v) {
      const Vec3f p = bar.positions[v];
      constraints.free.push_back(p.x > 0.51f && p.x < 1.49f);
      if (p.x < 1.49f) continue;
      constraints.handles.push_back(v);
      constraints.targets.push_back({0.5f + radius - (p.y - 0.1f), 0.1f + radius + (p.x - 1.5f), p.z});
    }
  }
};

TEST(Arap, ABentBarKeepsItsEdges) {
  const BentBar b;
  const ArapResult r = arap_deform(b.bar.positions, b.bar.triangles, b.constraints, {0.05f, 200, 1e-5});
  double sum = 0, worst = 0;
  int n = 0;
  for (const auto& t : b.bar.triangles)
    for (int k = 0; k < 3; ++k) {
      const float before = length(b.bar.positions[t[k]] - b.bar.positions[t[(k + 1) % 3]]);
      const float after = length(r.positions[t[k]] - r.positions[t[(k + 1) % 3]]);
      const double change = std::abs(after / before - 1);
      sum += change, worst = std::max(worst, change), ++n;
    }
  // A beam of half-height 0.1 bent to radius 0.64 strains its outermost fibers by 0.16.
  EXPECT_LT(sum / n, 0.05);
  EXPECT_LT(worst, 0.25);
}

TEST(Arap, SameBitsWhateverTheThreads) {
  const Tent tent({0.3f, 0.1f, 0.4f});
  const ArapResult one = Threads(1).run([&] { return tent.solve(); });
  const ArapResult all = tent.solve();
  ASSERT_EQ(one.energies, all.energies);
  for (size_t v = 0; v < one.positions.size(); ++v)
    EXPECT_TRUE(same_bits(one.positions[v], all.positions[v]));
}

TEST(Arap, LooseVerticesStay) {
  Mesh m = plane_mesh(4, 4, 0.1f);
  const ArapResult r =
      arap_deform(m.positions, m.triangles, {std::vector<uint8_t>(m.positions.size(), 1), {}, {}}, {0.1f});
  for (size_t v = 0; v < r.positions.size(); ++v) EXPECT_TRUE(same_bits(r.positions[v], m.positions[v]));
}

TEST(SurfaceGradient, OfAnAffineMapIsThatMapAlongTheSurface) {
  const Mesh m = sphere_mesh(0.5f, 4);
  const Mat3d a{{{1.3, 0.2, 0}, {-0.1, 0.8, 0.3}, {0, 0.1, 1.1}}};
  const Mat3d cofactor{{cross(a.row[1], a.row[2]), cross(a.row[2], a.row[0]), cross(a.row[0], a.row[1])}};
  std::vector<Vec3f> after;
  std::vector<uint32_t> vertices;
  for (uint32_t v = 0; v < m.positions.size(); ++v) {
    after.push_back(to_float(a * to_double(m.positions[v])));
    vertices.push_back(v);
  }
  const SurfaceGradient g = surface_gradient(m.positions, m.normals, after, m.triangles, vertices);
  for (const uint32_t v : vertices) {
    const Vec3d n = to_double(m.normals[v]), truth = normalize(cofactor * n);
    EXPECT_LT(length(to_double(g.normals[v]) - truth), 0.02) << v;
    Mat3d f;
    for (int k = 0; k < 9; ++k) f.row[k / 3][k % 3] = g.gradients[v][k];
    EXPECT_LT(length(f * n - to_double(g.normals[v])), 1e-5);
    const Vec3d t = normalize(cross(n, Vec3d{0.3, 0.5, 0.8}));
    EXPECT_LT(length(f * t - a * t), 0.03) << v;
  }
}

TEST(SurfaceGradient, OfARotationIsThatRotation) {
  const Mesh m = sphere_mesh(0.5f, 3);
  const Mat3d r = turn({1, 1, 0}, 2);
  std::vector<Vec3f> after;
  for (const Vec3f p : m.positions) after.push_back(to_float(r * to_double(p)));
  const SurfaceGradient g =
      surface_gradient(m.positions, m.normals, after, m.triangles, std::vector<uint32_t>{0, 17, 99});
  for (const auto& f : g.gradients)
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(f[k], r.row[k / 3][k % 3], 1e-5);
}

}  // namespace
}  // namespace cei3d
