// SPDX-License-Identifier: Apache-2.0
#include "engine/export/tangents.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/scalar.h"
#include "model/geometry/mesh/test_meshes.h"

namespace cei3d {
namespace {

TEST(Tangents, OfAPlatePointWhereUGrows) {
  const Mesh m = plane_mesh(4, 3, 1);
  std::vector<Vec2f> uv;
  for (const Vec3f p : m.positions)  // u along (3, 4) / 5, turned and scaled; v down is -(−4, 3) / 5
    uv.push_back({(3 * p.x + 4 * p.y) / 50, -(-4 * p.x + 3 * p.y) / 50});
  for (const Vec3f t : tangents_of(m.positions, m.normals, uv, m.triangles))
    EXPECT_NEAR(length(t - Vec3f{0.6f, 0.8f, 0}), 0, 1e-6);
}

// A ball by longitude and latitude: u grows eastwards.
TEST(Tangents, OfABallPointEast) {
  const Mesh m = sphere_mesh(2, 4);
  std::vector<Vec3f> positions, normals;
  std::vector<Vec2f> uv;
  std::vector<std::array<uint32_t, 3>> triangles;
  for (const auto& t : m.triangles) {
    bool near_pole_or_seam = false;
    for (const uint32_t v : t) {
      const Vec3f n = m.normals[v];
      near_pole_or_seam |= std::abs(n.z) > 0.8f || n.x < 0;
    }
    if (!near_pole_or_seam) triangles.push_back(t);
  }
  for (const Vec3f n : m.normals)
    uv.push_back({std::atan2(n.y, n.x) / (2 * kPi) + 0.5f, std::acos(clamp(n.z, -1.0f, 1.0f)) / kPi});
  const std::vector<Vec3f> t = tangents_of(m.positions, m.normals, uv, triangles);
  int seen = 0;
  for (const auto& triangle : triangles)
    for (const uint32_t v : triangle) {
      const Vec3f n = m.normals[v];
      EXPECT_NEAR(dot(t[v], n), 0, 1e-5);
      EXPECT_GT(dot(t[v], normalize(Vec3f{-n.y, n.x, 0})), 0.99f);
      ++seen;
    }
  EXPECT_GT(seen, 100);
}

TEST(Tangents, AFrameFindsItsDirectionsAgain) {
  const TangentFrame frame{{0.9f, 0.1f, -0.2f},
                           {0.15f, 0.2f, 0.85f}};  // interpolated: neither unit nor square
  for (const Vec3f d : {Vec3f{0, 0, 1}, normalize(Vec3f{0.3f, -0.2f, 0.9f}), normalize(frame.normal)}) {
    const Vec3f c = frame.coordinates(d);
    EXPECT_NEAR(length(c), 1, 1e-6);
    EXPECT_NEAR(length(frame.direction(c) - d), 0, 1e-5);
  }
  const Vec3f up = frame.coordinates(normalize(frame.normal));
  EXPECT_NEAR(up.z, 1, 1e-6);
}

}  // namespace
}  // namespace cei3d
