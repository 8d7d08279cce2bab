// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/sam_part.h"

#include <gtest/gtest.h>

#include "core/compute/device.h"
#include "engine/edit/handler_colors.h"
#include "engine/render/sphere_scene.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

// Handler points in the middles of the triangles that are well away from the poles.
Scene scene_with_handlers() {
  Scene scene = sphere_scene();
  HandlerPoints h;
  h.spacing = 0.02f;
  const Mesh& mesh = scene.surface->mesh();
  for (size_t t = 1000; t < mesh.triangles.size() - 1000; t += 7) {
    const auto& c = mesh.triangles[t];
    h.normals.push_back(normalize(mesh.positions[c[0]] + mesh.positions[c[1]] + mesh.positions[c[2]]));
    h.positions.push_back(h.normals.back() * kSphereRadius);
    h.footprints.push_back(0.01f);
  }
  scene.handlers = std::make_shared<HandlerPoints>(std::move(h));
  return scene;
}

TEST(HandlerColors, AreTheBaseColorOfThePointsThemselves) {
  const Device device = make_device();
  const Scene scene = scene_with_handlers();
  std::vector<Hit> hits;
  for (size_t i = 0; i < scene.handlers->positions.size(); ++i)
    hits.push_back(
        {scene.handlers->positions[i], scene.handlers->normals[i], scene.handlers->normals[i], 0, 0, 0});
  const std::vector<Vec3f> truth = appearance_at(device, scene, hits).albedo;
  const std::vector<Vec3f> colors = handler_colors(device, scene);
  ASSERT_EQ(colors.size(), truth.size());
  for (size_t i = 0; i < colors.size(); ++i) EXPECT_NEAR(length(colors[i] - truth[i]), 0, 2e-3);
}

TEST(HandlerColors, PictureShowsTheColorWhereThePointIs) {
  const Device device = make_device();
  const Scene scene = scene_with_handlers();
  const Camera camera = camera_towards_origin({2, 1, 0.5}, 64);
  const Image picture = albedo_image(device, scene, camera);
  EXPECT_EQ(picture.at(0, 0)[3], 0);
  const float* middle = picture.at(32, 32);
  EXPECT_EQ(middle[3], 1);
  const Vec3f n = normalize(Vec3f{2, 1, 0.5f});
  const std::vector<Hit> hit{{n * kSphereRadius, n, n, 0, 0, 0}};
  const Vec3f truth = appearance_at(device, scene, hit).albedo[0];
  EXPECT_NEAR(length(Vec3f{middle[0], middle[1], middle[2]} - truth), 0, 0.02);  // within a pixel's extent
}

}  // namespace
}  // namespace cei3d
