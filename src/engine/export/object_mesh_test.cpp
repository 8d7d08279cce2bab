// SPDX-License-Identifier: Apache-2.0
#include "engine/export/object_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <set>

#include "core/base/error_of.h"
#include "engine/export/test_ball.h"
#include "engine/io/ply.h"
#include "model/scene/appearance.h"
#include "model/scene/handler_hits.h"

namespace cei3d {
namespace {

Scene ball() { return test_ball(2, {.levels = 4}); }

bool above(Vec3f p) { return p.z > 0.1f; }

// Everything above a plane, by points that reach just as far as the ball's vertices need.
EditLayer upper_half(const Mesh& mesh) {
  EditLayer layer;
  layer.id = "0001-material";
  Region::Points points;
  for (size_t v = 0; v < mesh.positions.size(); ++v)
    if (above(mesh.positions[v])) {
      points.positions.push_back(mesh.positions[v]);
      points.normals.push_back(mesh.normals[v]);
      points.reach.push_back(1e-3f);
    }
  layer.region = Region(points);
  layer.material.roughness = 0.9f;
  return layer;
}

TEST(ObjectMesh, IsTheSurfaceInTheFrameOfTheCaptureWithTheColorOfTheField) {
  const Scene s = ball();
  const ColoredMesh out = colored_mesh(make_device(), s);
  const Mesh& mesh = s.surface->mesh();
  EXPECT_EQ(out.mesh.triangles, mesh.triangles);
  ASSERT_EQ(out.mesh.positions.size(), mesh.positions.size());
  std::vector<float> colors(mesh.positions.size() * 3);
  s.albedo->eval(make_device(), mesh.positions, colors);
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3f p = mesh.positions[v];
    EXPECT_NEAR(length(out.mesh.positions[v] - Vec3f{1 + p.x / 2, 2 + p.y / 2, 3 + p.z / 2}), 0, 1e-6);
    for (int c = 0; c < 3; ++c) EXPECT_EQ(out.mesh.colors[v][c], colors[v * 3 + c]);
  }
  ASSERT_EQ(out.materials.list.size(), 1u);
  EXPECT_EQ(out.materials.list[0].roughness, 0.4f);
}

TEST(ObjectMesh, TrianglesHaveTheMaterialOfMostOfTheirCorners) {
  const Scene s = ball();
  const Mesh& mesh = s.surface->mesh();
  const ColoredMesh out = colored_mesh(make_device(), with_layer(s, upper_half(mesh)));
  ASSERT_EQ(out.materials.of_triangle.size(), mesh.triangles.size());
  std::set<float> seen;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    const auto edited =
        std::count_if(corners.begin(), corners.end(), [&](uint32_t v) { return above(mesh.positions[v]); });
    const float roughness = out.materials.list[out.materials.of_triangle[t]].roughness;
    EXPECT_EQ(roughness, edited >= 2 ? 0.9f : 0.4f) << t;
    seen.insert(roughness);
  }
  EXPECT_EQ(seen.size(), 2u);
}

TEST(ObjectMesh, AMaterialThatNoTriangleHasIsLeftOut) {
  const Scene s = ball();
  EditLayer all;
  all.id = "0001-material";
  all.everywhere = true;
  all.material.roughness = 0.9f;
  const ColoredMesh out = colored_mesh(make_device(), with_layer(s, all));
  ASSERT_EQ(out.materials.list.size(), 1u);
  EXPECT_EQ(out.materials.list[0].roughness, 0.9f);
}

TEST(ObjectMesh, VerticesOfRemovedTrianglesAreLeftOut) {
  const Scene s = ball();
  const Mesh& mesh = s.surface->mesh();
  auto reshape = std::make_shared<Reshape>();
  std::set<std::array<float, 3>> left;  // corners of the triangles that stay
  size_t kept = 0;
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    if (std::any_of(corners.begin(), corners.end(), [&](uint32_t v) { return above(mesh.positions[v]); })) {
      reshape->removed.push_back(t);
      continue;
    }
    ++kept;
    for (const uint32_t v : corners) {
      const Vec3f p = mesh.positions[v];
      left.insert({p.x, p.y, p.z});
    }
  }
  EditLayer layer;
  layer.id = "0001-remove";
  layer.reshape = reshape;
  const ColoredMesh out = colored_mesh(make_device(), with_layer(s, layer));
  EXPECT_EQ(out.mesh.triangles.size(), kept);
  EXPECT_EQ(out.mesh.positions.size(), left.size());
  EXPECT_EQ(out.mesh.colors.size(), left.size());
  std::vector<bool> used(out.mesh.positions.size());
  for (const auto& corners : out.mesh.triangles)
    for (const uint32_t v : corners) used.at(v) = true;
  EXPECT_EQ(std::count(used.begin(), used.end(), false), 0);
  for (const Vec3f p : out.mesh.positions) EXPECT_LE(p.z, 3.05f + 1e-6f);
}

// The flat faces between points of the ball lie below it, most in their middles.
TEST(ObjectMesh, TheErrorOfSimplificationIsInUnitsOfTheCapture) {
  const Scene s = test_ball(4, {.levels = 4});
  const ColoredMesh out = colored_mesh(make_device(), s, 300);
  ASSERT_LE(out.mesh.triangles.size(), 300u);
  double below = 0;
  for (const auto& [a, b, c] : out.mesh.triangles) {
    const Vec3f middle = (out.mesh.positions[a] + out.mesh.positions[b] + out.mesh.positions[c]) / 3.0f;
    below = std::max(below, double(kBallRadius / 2 - length(middle - Vec3f{1, 2, 3})));
  }
  EXPECT_GT(out.error, 0.1 * below);
  EXPECT_LT(out.error, 1.0 * below);
  EXPECT_EQ(colored_mesh(make_device(), s).error, 0);
}

TEST(ObjectMesh, HandlerPointsAreInTheFrameOfTheCapture) {
  Scene s = ball();
  auto handlers = std::make_shared<HandlerPoints>();
  handlers->positions = {{0, 0, 0.5f}, {0.2f, -0.4f, 0}};
  handlers->normals = {{0, 0, 1}, {0, -1, 0}};
  handlers->footprints = {0.01f, 0.02f};
  handlers->spacing = 0.02f;
  s.handlers = handlers;
  const HandlerCloud cloud = handler_cloud(make_device(), s);
  const Mesh& points = cloud.points;
  EXPECT_TRUE(points.triangles.empty());
  ASSERT_EQ(points.positions.size(), 2u);
  EXPECT_NEAR(length(points.positions[0] - Vec3f{1, 2, 3.25f}), 0, 1e-6);
  EXPECT_NEAR(length(points.positions[1] - Vec3f{1.1f, 1.8f, 3}), 0, 1e-6);
  EXPECT_EQ(points.normals[1].y, -1);
}

TEST(ObjectMesh, HandlerPointsKnowTheirAlbedoFootprintAndPart) {
  Scene s = ball();
  auto handlers = std::make_shared<HandlerPoints>();
  handlers->positions = {{0, 0, kBallRadius}, {0, 0, -kBallRadius}};
  handlers->normals = {{0, 0, 1}, {0, 0, -1}};
  handlers->footprints = {0.01f, 0.02f};
  handlers->spacing = 0.02f;
  s.handlers = handlers;
  EditLayer lid = upper_half(s.surface->mesh());
  lid.part = "lid\nlock";
  s.layers = {lid};
  const HandlerCloud cloud = handler_cloud(make_device(), s);
  EXPECT_EQ(cloud.parts.of, (std::vector<uint8_t>{1, 0}));
  EXPECT_FLOAT_EQ(cloud.footprints[1], 0.01f);  // a unit of the capture is two of the unit frame
  const std::vector<Vec3f> albedo = appearance_at(make_device(), s, handler_hits(s)).albedo;
  for (size_t i = 0; i < 2; ++i) EXPECT_EQ(length(cloud.points.colors[i] - albedo[i]), 0);

  const std::string ply = encode_handlers(cloud);
  EXPECT_NE(ply.find("comment part 1 lid lock\n"), std::string::npos);
  EXPECT_NE(ply.find("property float footprint\nproperty uchar part\nelement face 0\n"), std::string::npos);
  const std::string last = ply.substr(ply.size() - 5);  // footprint and part of the second point
  float footprint;
  std::memcpy(&footprint, last.data(), 4);
  EXPECT_EQ(footprint, cloud.footprints[1]);
  EXPECT_EQ(last[4], 0);
  const Mesh read = decode_ply(ply, "points.ply");
  ASSERT_EQ(read.positions.size(), 2u);
  EXPECT_EQ(length(read.positions[1] - cloud.points.positions[1]), 0);
}

TEST(ObjectMesh, AnObjectWithoutSurfaceOrHandlersIsAnError) {
  const Scene nothing;
  EXPECT_THROW(colored_mesh(make_device(), nothing), Error);
  EXPECT_THROW(handler_cloud(make_device(), nothing), Error);
  Scene empty = ball();
  empty.surface = std::make_shared<Surface>(Mesh(), std::vector<uint8_t>());
  EXPECT_EQ(message([&] { colored_mesh(make_device(), empty); }),
            "There is no surface to export: the mesh is empty.");
}

}  // namespace
}  // namespace cei3d
