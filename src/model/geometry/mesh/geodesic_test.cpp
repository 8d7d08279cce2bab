// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/geodesic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

TEST(Geodesic, OnAPlaneItIsTheStraightLine) {
  const Mesh m = plane_mesh(30, 20, 0.1f);
  const uint32_t source = 31 * 7 + 4;
  const auto d = geodesic_distances(m.positions, m.triangles, source);
  for (size_t v = 0; v < d.size(); ++v)
    EXPECT_NEAR(d[v], length(m.positions[v] - m.positions[source]), 1e-5) << v;
}

TEST(Geodesic, OnASphereItIsTheGreatCircle) {
  const Mesh m = sphere_mesh(0.5f, 5);
  const uint32_t source = 100;
  const auto d = geodesic_distances(m.positions, m.triangles, source);
  for (size_t v = 0; v < d.size(); ++v) {
    const float arc = std::asin(min(0.5f * length(m.normals[v] - m.normals[source]), 1.0f));  // radius 0.5
    EXPECT_NEAR(d[v], arc, 0.015f * arc + 1e-4f) << v;
  }
}

TEST(Geodesic, WallsAreWalkedAround) {
  // A wall of vertices at x = 10 with a gap at the top. The triangles at the wall are closed, too: the path
  // turns at (9, 20), (10, 20) and (11, 19).
  const Mesh m = plane_mesh(20, 20, 1);
  const auto open = [](uint32_t v) { return v % 21 != 10 || v / 21 == 20; };
  const auto d = geodesic_distances(m.positions, m.triangles, 0, {kUnreached, open});
  EXPECT_FLOAT_EQ(d[21 * 5 + 10], kUnreached);
  EXPECT_NEAR(d[20], std::hypot(9.0f, 20.0f) + 1 + std::sqrt(2.0f) + std::hypot(9.0f, 19.0f), 0.3f);
}

TEST(Geodesic, StopsWhereItIsTold) {
  const Mesh m = plane_mesh(20, 20, 0.1f);
  const auto d = geodesic_distances(m.positions, m.triangles, 0, {0.75f, {}});
  for (size_t v = 0; v < d.size(); ++v) EXPECT_EQ(std::isinf(d[v]), length(m.positions[v]) > 0.75f) << v;
}

}  // namespace
}  // namespace cei3d
