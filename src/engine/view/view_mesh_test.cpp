// SPDX-License-Identifier: Apache-2.0
#include "engine/view/view_mesh.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/render/scene_light.h"
#include "engine/render/sphere_scene.h"
#include "engine/view/quantize.h"
#include "engine/view/test_pack.h"
#include "engine/view/visibility_harmonics.h"

namespace cei3d {
namespace {

float visibility_at(const VisibilityTerms& terms, Vec3f d) {
  const VisibilityTerms basis = visibility_basis(d);
  float sum = 0;
  for (size_t k = 0; k < kVisibilityTerms; ++k) sum += terms[k] * basis[k];
  return sum;
}

TEST(VisibilityHarmonics, AnOpenSkyIsVisibleEverywhere) {
  const Scene scene = sphere_scene();
  const std::vector<VisibilityTerms> terms = visibility_harmonics(*scene.surface);
  for (const Vec3f d : {Vec3f{1, 0, 0}, Vec3f{0, 0.6f, -0.8f}, normalize(Vec3f{1, 2, 3})})
    EXPECT_NEAR(visibility_at(terms[100], d), 1, 0.01);
}

// The projection of a step: 1/2 + 3/4 cosine; the second band of a hemisphere is 0.
TEST(VisibilityHarmonics, HalfASkyIsTheProjectionOfAStep) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}};
  std::vector<uint8_t> visible(3 * kSkyDirections / 8, 0);
  for (int k = 0; k < kSkyDirections; ++k)
    if (sky_directions()[size_t(k)].x > 0) visible[size_t(k / 8)] |= uint8_t(1 << (k % 8));
  const Surface surface(mesh, visible);
  const VisibilityTerms terms = visibility_harmonics(surface)[0];
  // Half of the upper sky is visible, so half of the lower one counts as visible everywhere: along x the step
  // has half its height.
  EXPECT_NEAR(visibility_at(terms, {0, 0, 1}), 0.5, 0.02);
  EXPECT_NEAR(terms[3], 0.375, 0.01);
  EXPECT_NEAR(terms[1], 0, 0.01);
}

TEST(ViewMesh, StreamsSayWhatTheSceneIs) {
  Scene scene = sphere_scene();
  scene.normalization.center = {10, -4, 2};
  scene.normalization.scale = 0.5;
  const Device device = make_device();
  const Mesh& mesh = scene.surface->mesh();
  const ViewMesh view = view_mesh(scene);
  const ReadPack shape(view_shape(scene, view)), look(view_look(device, scene, view));
  const auto positions = shape.array<uint16_t>("positions");
  const auto normals = shape.array<int16_t>("normals");
  const auto albedo = look.array<uint16_t>("albedo");
  const std::vector<Vec3f> truth = scene.albedo->eval3(device, mesh.positions);
  for (size_t i = 0; i < view.vertices.size(); i += 37) {
    const uint32_t v = view.vertices[i];
    for (int c = 0; c < 3; ++c) {
      const double low = shape.head.at("min")[size_t(c)], size = shape.head.at("size")[size_t(c)];
      EXPECT_NEAR(low + size * positions[4 * i + size_t(c)] / 65535,
                  scene.normalization.capture_from_unit(to_double(mesh.positions[v]))[c], 3e-5 * size);
      EXPECT_NEAR(std::pow(float(albedo[4 * i + size_t(c)]) / 65535, 2.0f), truth[v][c], 5e-5);
    }
    const Vec3f n =
        direction_from_octahedron({float(normals[2 * i]) / 32767, float(normals[2 * i + 1]) / 32767});
    EXPECT_GT(dot(n, mesh.normals[v]), 0.99999f);
  }
  EXPECT_EQ(shape.array<uint32_t>("triangles").size(), 3 * mesh.triangles.size());
}

TEST(ViewMesh, FewerFacesKeepVerticesOfTheSurface) {
  const Scene scene = sphere_scene();
  const ViewMesh view = view_mesh(scene, 2000);
  EXPECT_LE(view.triangles.size(), 2000u);
  EXPECT_GT(view.triangles.size(), 500u);
  for (const auto& t : view.triangles)
    for (const uint32_t v : t) ASSERT_LT(v, view.vertices.size());
  for (const uint32_t v : view.vertices) ASSERT_LT(v, scene.surface->mesh().positions.size());
  Scene half = scene;
  half.normalization.scale *= 2;
  EXPECT_GT(view.error, 0);
  EXPECT_NEAR(view_mesh(half, 2000).error, view.error / 2, 1e-6 * view.error);
}

TEST(ViewMesh, CoarseTrianglesLieOnTheSurface) {
  const Scene scene = sphere_scene();
  const ViewMesh view = view_mesh(scene);
  const auto corners = ReadPack(view_coarse(scene, view)).array<uint32_t>("triangles");
  EXPECT_LE(corners.size(), 3 * 30'000u);
  EXPECT_GT(corners.size(), 3 * 500u);
  const auto corner = [&](size_t i) { return scene.surface->mesh().positions[view.vertices.at(corners[i])]; };
  for (size_t i = 0; i < corners.size(); i += 3)
    EXPECT_NEAR(length((corner(i) + corner(i + 1) + corner(i + 2)) / 3.0f), kSphereRadius, 0.01f);
}

TEST(ViewMesh, VerticesKnowTheirPart) {
  Scene scene = sphere_scene();
  const std::vector<Vec3f>& positions = scene.surface->mesh().positions;
  EditLayer cap;
  cap.part = "cap";
  Region::Points points;
  points.positions = {{0, 0, kSphereRadius}};
  points.normals = {{0, 0, 1}};
  points.reach = {0.4f};
  cap.region = Region(points);
  scene = with_layer(scene, cap);
  const ViewMesh view = view_mesh(scene);
  const ReadPack look(view_look(make_device(), scene, view));
  EXPECT_EQ(look.head.at("parts"), (Json{"", "cap"}));
  const auto material = look.array<uint8_t>("material");
  for (size_t i = 0; i < view.vertices.size(); ++i) {
    const float distance = length(positions[view.vertices[i]] - points.positions[0]);
    if (std::abs(distance - 0.4f) < 0.01f) continue;
    ASSERT_EQ(material[4 * i + 3], distance < 0.4f ? 1 : 0);
  }
}

TEST(ViewMesh, AnObjectWithoutSurfaceIsRefused) {
  EXPECT_THROW(view_mesh(Scene()), Error);
  Scene empty = sphere_scene();
  Mesh none = empty.surface->mesh();
  none.triangles.clear();
  empty.surface = std::make_shared<Surface>(none, empty.surface->visibility());
  EXPECT_THROW(view_mesh(empty), Error);
}

TEST(ViewMesh, VertexLightIsThatOfTheScene) {
  const Scene scene = sphere_scene();
  const Device device = make_device();
  const SceneLight light(device, scene, scene_transports(scene));
  const ViewMesh view = view_mesh(scene);
  const ReadPack pack(view_vertex_light(light.vertices(), view));
  const auto visibility = pack.array<uint8_t>("visibility");
  const auto bounce = pack.array<uint32_t>("bounce");
  for (size_t i = 0; i < view.vertices.size(); i += 41) {
    EXPECT_NEAR(float(visibility[4 * i]) / 255, light.vertices().visibility[view.vertices[i]].x, 0.003);
    EXPECT_EQ(bounce[i], shared_exponent(light.vertices().bounce[view.vertices[i]]));
  }
}

}  // namespace
}  // namespace cei3d
