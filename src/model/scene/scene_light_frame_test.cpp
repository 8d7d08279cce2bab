// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/math/rotation.h"
#include "model/scene/scene.h"

namespace cei3d {
namespace {

Camera turned_camera(float azimuth) {
  Camera camera;
  const Mat3f r = about_axis({0, 0, 1}, azimuth);
  for (int i = 0; i < 3; ++i) camera.world_from_cam.row[i] = to_double(r.row[i]);
  return camera;
}

Scene on_a_turntable() {
  Scene scene;
  scene.light = {{{{1, 0, 0}, 10, {1, 2, 3}}}};
  scene.light_frame = {LightMotion::turntable, {0, 0, 1}, about_axis({0, 0, 1}, 0.3f)};
  scene.light_error = Vec3f{0.05f, 0.1f, 0.2f};
  return scene;
}

TEST(SceneLightFrame, TheLightGoesRoundWithTheCamera) {
  const Scene scene = on_a_turntable();
  const Vec3f first = light_in_view(scene, turned_camera(0.3f)).lobes[0].axis,
              later = light_in_view(scene, turned_camera(0.3f + kPi / 2)).lobes[0].axis;
  EXPECT_LT(length(first - Vec3f{1, 0, 0}), 1e-5f);
  EXPECT_LT(length(later - Vec3f{0, 1, 0}), 1e-5f);
}

TEST(SceneLightFrame, IsStored) {
  const Scene scene = on_a_turntable();
  Tensors tensors;
  Json head;
  save_scene(scene, tensors, head);
  const Scene back = load_scene(tensors, head);
  const Camera camera = turned_camera(2);
  EXPECT_EQ(to_array(light_in_view(back, camera)), to_array(light_in_view(scene, camera)));
  EXPECT_EQ(back.light_error->z, 0.2f);
  head["light_frame"]["motion"] = "train";
  EXPECT_THROW(load_scene(tensors, head), Error);
}

TEST(SceneLightFrame, IsStoredWithItsRings) {
  Scene scene = on_a_turntable();
  scene.light_frame.rings = {{{0, 0, 1}, -0.6f, 0.02f}, {normalize(Vec3f{0, 1, 0.2f}), -0.4f, 0}};
  Tensors tensors;
  Json head;
  save_scene(scene, tensors, head);
  const Scene back = load_scene(tensors, head), without = on_a_turntable();
  Camera camera = turned_camera(2);
  camera.world_from_cam = upright_rotation({0.3, 0.5, -0.6}, {0, 0, 1});
  EXPECT_EQ(to_array(light_in_view(back, camera)), to_array(light_in_view(scene, camera)));
  EXPECT_NE(to_array(light_in_view(without, camera)), to_array(light_in_view(scene, camera)));
  head["light_frame"]["rings"][1].erase("right");
  EXPECT_THROW(load_scene(tensors, head), Error);
}

TEST(SceneLightFrame, ALightPutThereByAnEditStandsStill) {
  EditLayer layer;
  layer.light = SgMixture{{{{0, 1, 0}, 5, {1, 1, 1}}}};
  const Scene scene = with_layer(on_a_turntable(), layer);
  EXPECT_EQ(to_array(light_in_view(scene, turned_camera(2))), to_array(*layer.light));
}

}  // namespace
}  // namespace cei3d
