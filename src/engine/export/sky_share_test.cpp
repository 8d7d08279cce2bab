// SPDX-License-Identifier: Apache-2.0
#include "engine/export/sky_share.h"

#include <gtest/gtest.h>

#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

// A vertex in the corner between two large plates at a right angle sees half of the cosine-weighted sky.
TEST(SkyShare, HalfOfItIsFreeBesideAWall) {
  Mesh m = plane_mesh(1, 1, 20);
  for (Vec3f& p : m.positions) p = p - Vec3f{10, 10, 0};
  m.positions.push_back({0.01f, 0, 0});  // a small triangle on the floor, at the foot of the wall
  m.positions.push_back({0.02f, 0, 0});
  m.positions.push_back({0.01f, 0.01f, 0});
  m.triangles.push_back({4, 5, 6});
  for (const Vec3f p : {Vec3f{0, -10, -1}, Vec3f{0, 10, -1}, Vec3f{0, 10, 20}, Vec3f{0, -10, 20}})
    m.positions.push_back(p);
  m.triangles.push_back({7, 8, 9});
  m.triangles.push_back({7, 9, 10});
  m.normals.assign(m.positions.size(), Vec3f{0, 0, 1});
  const std::vector<float> share = sky_shares(Surface(m));
  EXPECT_NEAR(share[4], 0.5, 0.02);
}

TEST(SkyShare, AllOfItIsFreeOnABall) {
  for (const float s : sky_shares(Surface(sphere_mesh(1, 3)))) EXPECT_GT(s, 0.99f);
}

}  // namespace
}  // namespace cei3d
