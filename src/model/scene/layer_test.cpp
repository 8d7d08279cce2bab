// SPDX-License-Identifier: Apache-2.0
#include "model/scene/layer.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/test_unknown_keys.h"
#include "model/scene/scene.h"

namespace cei3d {
namespace {

Region some_region() { return Region({{{0, 0, 0.5f}}, {{0, 0, 1}}, {0.1f}, {}}); }

std::shared_ptr<const Field> some_field() {
  FieldConfig c;
  c.encoding.levels = 2;
  c.encoding.log2_table = 6;
  c.outputs = 3;
  return std::make_shared<Field>(c, 5);
}

std::shared_ptr<const Reshape> some_reshape() {
  auto r = std::make_shared<Reshape>();
  r->moved = {3};
  r->positions = {{0, 0, 1}};
  r->normals = {{0, 1, 0}};
  r->gradients = {{1, 0, 0, 0, 1, 0, 0, 0, 1}};
  return r;
}

std::vector<EditLayer> one_of_each_kind() {
  std::vector<EditLayer> layers(9);
  for (EditLayer& l : layers) l.id = "0001-test";
  layers[0].region = some_region();
  layers[0].albedo = some_field();
  layers[1].everywhere = true;
  layers[1].material = {0.5f, std::nullopt, 1.0f};
  layers[2].region = some_region();
  layers[2].part = "left ear";
  layers[2].tint = Tint{{0.1f, 0.2f, 0.3f}, true, {0.4f, 0.5f, 0.6f}};
  layers[3].light = SgMixture{{{{0, 0, 1}, 3.5f, {1, 2, 3}}}};
  layers[4].reshape = some_reshape();
  layers[5] = layers[2];
  layers[5].tint->keep_texture = false;
  layers[5].tint->blend = 0.25f;
  layers[5].material = {.specular = 0.0f, .roughness_scale = 0.5f, .blend = 0.25f};
  layers[6].everywhere = true;
  layers[6].albedo = some_field();
  layers[6].unlit = true;
  layers[7] = layers[0];
  layers[7].also = {some_region(), Region({{{0.5f, 0, 0}}, {{1, 0, 0}}, {0.2f}, {}})};
  layers[7].albedo = nullptr;
  layers[7].erase = layers[7].erase_material = true;
  layers[8].reshape = some_reshape();
  layers[8].sdf = some_field();
  return layers;
}

std::string bytes_of(const EditLayer& layer) {
  Tensors tensors;
  Json head = Json::object();
  save_layer(layer, tensors, head);
  return tensors_to_bytes(tensors) + head.dump();
}

TEST(EditLayer, LoadGivesWhatWasSaved) {
  for (const EditLayer& layer : one_of_each_kind()) {
    Tensors tensors;
    Json head = Json::object();
    save_layer(layer, tensors, head);
    const EditLayer again =
        load_layer(tensors_from_bytes(tensors_to_bytes(tensors), "test"), Json::parse(head.dump()));
    EXPECT_EQ(bytes_of(again), bytes_of(layer));
    EXPECT_EQ(again.part, layer.part);
    EXPECT_EQ(bool(again.sdf), bool(layer.sdf));
    EXPECT_EQ(again.everywhere, layer.everywhere);
    EXPECT_EQ(again.unlit, layer.unlit);
    EXPECT_EQ(again.erase_material, layer.erase_material);
    EXPECT_EQ(again.material, layer.material);
    ASSERT_EQ(again.tint.has_value(), layer.tint.has_value());
    if (layer.tint) {
      EXPECT_EQ(again.tint->blend, layer.tint->blend);
    }
    EXPECT_EQ(bool(again.reshape), bool(layer.reshape));
  }
}

Region seen_region() {
  Projector projector;
  projector.camera.width = projector.camera.height = 2;
  projector.min_alpha = 0.25f;
  projector.alpha = projector.depth = Image(2, 2, 1);
  return Region({{{0, 0, 0.5f}}, {{0, 0, 1}}, {0.1f}, {}}, projector);
}

TEST(EditLayer, RefusesUnknownKeysWhereverTheyAre) {
  std::vector<EditLayer> layers = one_of_each_kind();
  layers[0].region = seen_region();
  layers[2].region = Region(ScoredPoints({{{0, 0, 0.5f}}, {{0, 0, 1}}, {1.0f}, 0.1f}));
  for (const EditLayer& layer : layers) {
    Tensors tensors;
    Json head = Json::object();
    save_layer(layer, tensors, head);
    EXPECT_NO_THROW(load_layer(tensors, head));
    const auto read = [&](const Json& bad) { load_layer(tensors, bad, "edit.json"); };
    EXPECT_EQ(objects_with_unknown_keys_read(head, "edit.json", read), std::vector<std::string>());
  }
}

TEST(EditLayer, ReadsTheFirstFormat) {  // region and albedo, nothing else
  const EditLayer paint = one_of_each_kind()[0];
  Tensors tensors;
  Json head = {{"id", "0001-paint"}, {"albedo", to_json(paint.albedo->config())}};
  paint.region.save(tensors, head["region"]);
  paint.albedo->params().save(tensors, "albedo");
  const EditLayer layer = load_layer(tensors, head);
  EXPECT_TRUE(layer.contains({0, 0, 0.5f}, {0, 0, 1}));
  EXPECT_FALSE(layer.contains({0, 0, 0.5f}, {0, 0, -1}));
  EXPECT_TRUE(layer.albedo);
  EXPECT_FALSE(layer.everywhere || layer.tint || layer.light || layer.reshape || !layer.material.empty());
}

// Layers were stored before materials could be scaled and blended.
TEST(EditLayer, ReadsMaterialsAndTintsThatOnlyReplace) {
  const Json head = {{"id", "0001-material"},
                     {"everywhere", true},
                     {"material", {{"roughness", 0.5}}},
                     {"tint", {{"color", {1, 0, 0}}, {"keep_texture", true}, {"mean", {1, 1, 1}}}}};
  const EditLayer layer = load_layer({}, head);
  EXPECT_EQ(layer.material, MaterialChange{.roughness = 0.5f});
  EXPECT_EQ(layer.tint->blend, 1);
  Tensors tensors;
  Json again = Json::object();
  save_layer(layer, tensors, again);
  EXPECT_EQ(again.dump().find("blend"), std::string::npos);  // older programs read it, too
}

TEST(EditLayer, AMaterialWithAnUnknownKeyIsRefused) {
  const Json head = {{"id", "0001-material"}, {"everywhere", true}, {"material", {{"roughness_scal", 0.5}}}};
  EXPECT_THROW(load_layer({}, head), Error);
}

TEST(EditLayer, DamageIsASentence) {
  for (const Json& head : {Json::object(), Json{{"id", 3}}, Json{{"id", "x"}},
                           Json{{"id", "x"}, {"everywhere", true}, {"tint", 1}}})
    EXPECT_THROW(load_layer({}, head), Error) << head.dump();
}

std::shared_ptr<const Surface> tetrahedron() {
  Mesh m;
  m.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  m.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return std::make_shared<const Surface>(std::move(m));
}

TEST(Scene, LayersSayTheirPoseAndTheLastLightCounts) {
  Scene s;
  s.surface = tetrahedron();
  s.light.lobes.resize(2);
  for (const EditLayer& layer : one_of_each_kind()) s = with_layer(std::move(s), layer);
  s = with_layer(std::move(s), one_of_each_kind()[1]);
  EXPECT_EQ(s.shape_versions.size(), 3u);
  EXPECT_EQ(s.surface, s.shape_versions.back()->surface);
  std::vector<int> versions;
  for (const EditLayer& layer : s.layers) versions.push_back(layer.shape_version);
  EXPECT_EQ(versions, (std::vector<int>{0, 0, 0, 0, 0, 1, 1, 1, 1, 2}));
  ASSERT_EQ(s.light.lobes.size(), 1u);
  EXPECT_EQ(s.light.lobes[0].lambda, 3.5f);
}

}  // namespace
}  // namespace cei3d
