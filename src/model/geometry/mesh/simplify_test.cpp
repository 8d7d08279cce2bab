// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/simplify.h"

#include <gtest/gtest.h>

#include "model/geometry/mesh/compact.h"
#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

TEST(Simplify, ABallStaysABallWithinTheErrorThatItSays) {
  const Mesh ball = sphere_mesh(2, 6);  // 32768 triangles
  const Simplified out = simplified(ball, 2000);
  EXPECT_LE(out.mesh.triangles.size(), 2000u);
  EXPECT_GE(out.mesh.triangles.size(), 1900u);
  ASSERT_EQ(out.mesh.normals.size(), out.mesh.positions.size());
  // A ball of n equal triangles lies up to about 4.8 R / n below the sphere in their middles.
  float deepest = 0;
  for (const auto& t : out.mesh.triangles)
    deepest = std::max(deepest, 2 - length(at_corners(out.mesh.positions, t, 1 / 3.0f, 1 / 3.0f)));
  EXPECT_GT(out.error, 0.0005f);
  EXPECT_LT(out.error, 0.02f);
  EXPECT_LT(deepest, 0.02f);
  for (size_t v = 0; v < out.mesh.positions.size(); ++v) {
    EXPECT_NEAR(length(out.mesh.positions[v]), 2, 1e-5);
    EXPECT_NEAR(length(out.mesh.normals[v] - out.mesh.positions[v] * 0.5f), 0, 1e-5);
  }
}

TEST(Simplify, TheErrorIsInTheUnitOfThePositions) {
  const Mesh small = sphere_mesh(1, 5), large = sphere_mesh(1024, 5);  // a power of two: the same bits
  EXPECT_EQ(simplified(large, 500).error, 1024 * simplified(small, 500).error);
}

TEST(Simplify, APlateKeepsItsOutline) {
  const Mesh out = simplified(plane_mesh(20, 10, 0.1f), 40).mesh;
  float area = 0;
  for (const auto& t : out.triangles)
    area +=
        length(cross(out.positions[t[1]] - out.positions[t[0]], out.positions[t[2]] - out.positions[t[0]])) /
        2;
  EXPECT_LE(out.triangles.size(), 40u);
  EXPECT_NEAR(area, 2, 1e-4);
}

TEST(Simplify, TrianglesWithoutAreaAndUnusedVerticesGo) {
  Mesh m = plane_mesh(2, 2, 1);
  m.triangles.push_back({0, 1, 2});  // three vertices of one edge
  m.triangles.push_back({4, 4, 5});
  m.positions.push_back({9, 9, 9});
  m.normals.push_back({0, 0, 1});
  const Simplified out = simplified(m, 1000);
  EXPECT_EQ(out.mesh.triangles.size(), 8u);
  EXPECT_EQ(out.mesh.positions.size(), 9u);
  EXPECT_EQ(out.error, 0);
}

}  // namespace
}  // namespace cei3d
