// SPDX-License-Identifier: Apache-2.0
#include "engine/render/seen_history.h"

#include <gtest/gtest.h>

#include <cstring>

#include "engine/render/scene_light.h"
#include "engine/render/sphere_scene.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

Region cap(Vec3f where, float radius) { return Region({{where * kSphereRadius}, {where}, {radius}, {}}); }

EditLayer named(const std::string& id) {
  EditLayer layer;
  layer.id = layer.content = id;
  return layer;
}

EditLayer paint(const Scene& scene, const std::string& id, Vec3f where, float radius, uint64_t seed) {
  EditLayer layer = named(id);
  layer.region = cap(where, radius);
  layer.albedo = std::make_shared<const Field>(scene.albedo->config(), seed);
  return layer;
}

// Paint that overlaps, paint that is erased, a tint and a material of all, light, and a part that changes
// nothing.
Scene edited_sphere() {
  Scene s = sphere_scene();
  s = with_layer(s, paint(s, "a", {0, 0, 1}, 0.4f, 7));
  s = with_layer(s, paint(s, "b", {0, 0.6f, 0.8f}, 0.3f, 8));
  EditLayer part = named("c");
  part.region = cap({1, 0, 0}, 0.3f);
  part.part = "side";
  s = with_layer(s, part);
  EditLayer all = named("d");
  all.everywhere = true;
  all.tint = Tint{{0.1f, 0.3f, 0.5f}, true, {0.5f, 0.5f, 0.5f}};
  all.material.roughness = 0.4f;
  s = with_layer(s, all);
  EditLayer erased = named("e");
  erased.region = cap({0, 0, 1}, 0.25f);
  erased.erase = erased.erase_material = true;
  s = with_layer(s, erased);
  return with_layer(s, paint(s, "f", {1, 0, 0}, 0.2f, 9));
}

Scene first_layers(Scene scene, size_t n) {
  scene.layers.resize(n);
  return scene;
}

VertexMaterials brute_force(const Device& device, const Scene& scene) {
  Appearance look = appearance_at(device, scene, vertex_hits(scene.surface->mesh()));
  return {std::move(look.albedo), std::move(look.material)};
}

bool same(const VertexMaterials& a, const VertexMaterials& b) {
  return a.albedo.size() == b.albedo.size() && a.material == b.material &&
         std::memcmp(a.albedo.data(), b.albedo.data(), a.albedo.size() * sizeof(Vec3f)) == 0;
}

TEST(SeenHistory, IsWhatAnEvaluationOfAllVerticesGives) {
  const Device device = make_device();
  const Scene scene = edited_sphere();
  const int last = int(scene.layers.size()) - 1;
  const SeenHistory history = SeenHistory(rest_materials(device, scene)).through(device, scene, last, 0);
  SeenHistory::Walk walk(history);
  for (int l = 0; l <= last; ++l)
    EXPECT_TRUE(same(walk.after(l), brute_force(device, first_layers(scene, size_t(l) + 1)))) << l;
}

TEST(SeenHistory, IdsNameTheMaterials) {
  const Device device = make_device();
  const Scene scene = edited_sphere();
  const SeenHistory none(rest_materials(device, scene)), history = none.through(device, scene, 5, 0);
  for (int a = -1; a < 6; ++a)
    for (int b = -1; b < a; ++b)
      EXPECT_EQ(history.id(a) == history.id(b), a == 2 && b == 1) << a << ' ' << b;  // a part changes nothing
  Scene undone = first_layers(scene, 1);
  EditLayer erased = named("g");
  erased.region = cap({0, 0, 1}, 0.5f);
  erased.erase = erased.erase_material = true;
  undone = with_layer(undone, erased);
  EXPECT_EQ(none.through(device, undone, 1, 0).id(1), none.id(-1));
}

TEST(SeenHistory, GoesOnFromWhatTwoScenesHaveInCommon) {
  const Device device = make_device();
  const Scene scene = edited_sphere();
  Scene other = first_layers(scene, 2);
  other = with_layer(other, paint(other, "h", {0, -1, 0}, 0.5f, 11));
  const SeenHistory none(rest_materials(device, scene));
  const SeenHistory there = none.through(device, scene, 5, 0).through(device, other, 2, 0),
                    anew = none.through(device, other, 2, 0);
  EXPECT_EQ(there.id(2), anew.id(2));
  EXPECT_TRUE(same(SeenHistory::Walk(there).after(2), brute_force(device, other)));
}

// As tiles of a frame ask for it, each up to the last layer that it shows.
TEST(SeenHistory, KnowsWhatFewerLayersNeed) {
  const Device device = make_device();
  const Scene scene = edited_sphere();
  Scene other = first_layers(scene, 3);
  other = with_layer(other, paint(other, "h", {0, -1, 0}, 0.5f, 11));
  const SeenHistory history = SeenHistory(rest_materials(device, scene)).through(device, scene, 4, 0);
  for (int last = -1; last < 6; ++last) EXPECT_EQ(history.reaches(scene, last), last <= 4) << last;
  for (int last = -1; last < 4; ++last) EXPECT_EQ(history.reaches(other, last), last <= 2) << last;
  const SeenHistory longer = history.through(device, scene, 5, 0);
  EXPECT_EQ(longer.bytes(), SeenHistory(rest_materials(device, scene)).through(device, scene, 5, 0).bytes());
  SeenHistory::Walk walk(history);
  EXPECT_TRUE(same(walk.after(1), brute_force(device, first_layers(scene, 2))));
}

TEST(SeenHistory, SmallEditsTakeLittleRoom) {
  const Device device = make_device();
  Scene scene = sphere_scene();
  for (int i = 0; i < 50; ++i)
    scene = with_layer(scene, paint(scene, std::to_string(i), {1, 0, 0}, 0.06f, uint64_t(i)));
  const SeenHistory none(rest_materials(device, scene)), history = none.through(device, scene, 49, 0);
  EXPECT_LT(history.bytes(), 2 * none.bytes());
}

}  // namespace
}  // namespace cei3d
