// SPDX-License-Identifier: Apache-2.0
#include "model/scene/residual.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/test_unknown_keys.h"
#include "core/math/rng.h"
#include "model/scene/scene.h"

namespace cei3d {
namespace {

// Smooth activations, so that finite differences cross no kink of the features'.
std::shared_ptr<Field> random_features(uint64_t seed) {
  FieldConfig c;
  c.encoding = {0, 4, 4, 20, 10};
  c.width = 16;
  c.outputs = 1 + 6;
  c.activation = Activation::softplus;
  c.softplus_beta = 10;
  auto field = std::make_shared<Field>(c, seed);
  for (Param& p : field->params().all())
    for (size_t i = 0; i < p.count(); ++i)
      if (p.name.starts_with("encoding")) p.value[i] = 0.3f * Rng(seed, 1, i).normal();
  return field;
}

Residual random_residual(std::shared_ptr<const Field> features) {
  Residual r = make_residual(std::move(features), 3);
  Param& last = r.params.all()[r.params.all().size() - 2];  // zero to start with
  for (size_t i = 0; i < last.count(); ++i) last.value[i] = 0.2f * Rng(5, 5, i).normal();
  return r;
}

std::vector<Hit> random_hits(int n) {
  std::vector<Hit> hits;
  for (int i = 0; i < n; ++i) {
    Rng rng(11, 0, uint64_t(i));
    const auto random = [&] { return Vec3f{rng.normal(), rng.normal(), rng.normal()}; };
    Hit h;
    h.position = normalize(random()) * 0.6f;
    h.normal = normalize(random());
    h.to_camera = normalize(random());
    hits.push_back(h);
  }
  return hits;
}

Vec3f weight_of(int hit) {
  Rng rng(13, 0, uint64_t(hit));
  return {rng.normal(), rng.normal(), rng.normal()};
}

double loss(const Device& device, const Residual& r, const std::vector<Hit>& hits) {
  const std::vector<Vec3f> values = residual_at(device, r, hits);
  double sum = 0;
  for (size_t i = 0; i < hits.size(); ++i)
    for (int c = 0; c < 3; ++c) sum += double(weight_of(int(i))[c]) * values[i][c];
  return sum;
}

TEST(Residual, GradientOfItsFeaturesEqualsFiniteDifferences) {
  const Device device = make_device("cpu/scalar");
  const std::shared_ptr<Field> features = random_features(1);
  const Residual residual = random_residual(features);
  const std::vector<Hit> hits = random_hits(40);
  const MlpWeights weights(residual.network, residual.params),
      feature_weights(mlp_config(features->config()), features->params());
  ResidualPass pass(features->config(), residual.network);
  const int n = pass.forward(device, *features, feature_weights, weights, hits);
  for (int i = 0; i < n; ++i) pass.set_output_grad(i, i < int(hits.size()) ? weight_of(i) : Vec3f{0, 0, 0});
  std::vector<float> network(weights.gradient_size());
  pass.backward(device, weights, n, network.data());
  std::vector<ChunkGradients> g(1);
  pass.backward_features(device, feature_weights, n, g[0]);
  Optimizer optimizer;
  optimizer.add(features->params(), "", {});
  accumulate_gradients(device, *features, g, features->config().encoding.levels, optimizer);

  int checked = 0;
  for (Param& p : features->params().all()) {
    const std::span<float> got = optimizer.gradient(p);
    // The largest of each: steps must be large enough for floats, and few kinks of the network's in between.
    const size_t at = size_t(std::max_element(got.begin(), got.begin() + std::ptrdiff_t(p.count()),
                                              [](float a, float b) { return std::abs(a) < std::abs(b); }) -
                             got.begin());
    const float h = 2e-3f, keep = p.value[at];
    p.value[at] = keep + h;
    const double above = loss(device, residual, hits);
    p.value[at] = keep - h;
    const double below = loss(device, residual, hits);
    p.value[at] = keep;
    EXPECT_NEAR(got[at], (above - below) / (2 * h), 0.03 * std::abs(got[at])) << p.name;
    checked += std::abs(got[at]) > 0.01f;
  }
  EXPECT_GE(checked, 6);
  for (int row = 0; row < features->config().width; ++row)  // the distance itself is no feature
    EXPECT_EQ(optimizer.gradient(features->params().get("layer1/weight"))[row], 0);
}

Scene scene_with(std::shared_ptr<const Field> sdf, Residual residual) {
  Scene s;
  s.sdf = std::move(sdf);
  s.residual = std::make_shared<const Residual>(std::move(residual));
  return s;
}

TEST(Residual, IsStoredWithItsFeaturesOrThoseOfTheDistanceField) {
  const Device device = make_device("cpu");
  const std::vector<Hit> hits = random_hits(40);
  const std::shared_ptr<Field> sdf = random_features(1), own = random_features(2);
  for (const auto& features : {sdf, own}) {
    const Scene scene = scene_with(sdf, random_residual(features));
    Tensors tensors;
    Json head;
    save_scene(scene, tensors, head);
    const Scene back = load_scene(tensors, head);
    EXPECT_EQ(back.residual->features == back.sdf, features == sdf);
    EXPECT_EQ(loss(device, *back.residual, hits), loss(device, *scene.residual, hits));
  }
}

// A scene that has all there is to be stored.
Scene full_scene() {
  Scene s = scene_with(random_features(1), random_residual(random_features(2)));
  s.albedo = random_features(3);
  s.material = {Material{}, random_features(4)};
  s.light = {{{{0, 0, 1}, 3.5f, {1, 2, 3}}}};
  s.light_error = Vec3f{0.1f, 0.1f, 0.1f};
  s.light_frame.motion = LightMotion::turntable;
  s.explained = {20, 21};
  s.handlers = std::make_shared<const HandlerPoints>();
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  s.surface = std::make_shared<const Surface>(std::move(mesh));
  return s;
}

TEST(Scene, RefusesUnknownKeysWhereverTheyAre) {
  Tensors tensors;
  Json head;
  save_scene(full_scene(), tensors, head);
  EXPECT_NO_THROW(load_scene(tensors, head));
  EXPECT_GE(head.size(), 15u);
  const auto read = [&](const Json& bad) { load_scene(tensors, bad, "scene.json"); };
  EXPECT_EQ(objects_with_unknown_keys_read(head, "scene.json", read), std::vector<std::string>());
}

TEST(Scene, OfAnotherTableOfDirectionsIsRefused) {
  Tensors tensors;
  Json head;
  save_scene(full_scene(), tensors, head);
  head["surface"]["sky_directions"] = 256;
  EXPECT_NE(message([&] { load_scene(tensors, head); }).find("Reconstruct the object again"),
            std::string::npos);
}

TEST(Residual, OfProjectVersionTwoIsReadWithTwoLayers) {
  const std::shared_ptr<Field> sdf = random_features(1);
  Tensors tensors;
  Json head;
  save_scene(scene_with(sdf, make_residual(sdf, 4, 2)), tensors, head);
  head["residual"] = true;
  EXPECT_EQ(load_scene(tensors, head).residual->network.hidden_layers, 2);
  head["residual"] = {{"layers", 1000000}};
  EXPECT_THROW(load_scene(tensors, head), Error);
}

}  // namespace
}  // namespace cei3d
