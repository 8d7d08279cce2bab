// SPDX-License-Identifier: Apache-2.0
// A sphere that glows where it mirrors one direction, which its light and material do not know of.
#include "engine/reconstruct/appearance/residual_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/json.h"
#include "engine/render/render.h"
#include "engine/render/scene_light.h"
#include "engine/render/sphere_scene.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

Vec3f glow(const Hit& h) {
  const float c = std::max(0.0f, mirror_direction(h).x);
  return Vec3f{0.4f, 0.3f, 0.2f} * (c * c * c * c);
}

std::vector<Hit> seen_from(const Device& device, const Scene& scene, Vec3d center) {
  return trace_view(device, scene, camera_towards_origin(center, 96), 1).hits;
}

// Hits of eight views, colored as the physical model and the glow have them.
struct Photographed {
  explicit Photographed(const Device& device, const Scene& scene) {
    for (int v = 0; v < 8; ++v) {
      const double turn = 0.785 * v;
      const std::vector<Hit> more =
          seen_from(device, scene, {3 * std::cos(turn), 3 * std::sin(turn), v % 2 ? 1.0 : -1.0});
      hits.insert(hits.end(), more.begin(), more.end());
    }
    const Shading s =
        SceneLight(device, scene, scene_transports(scene)).shade(hits, appearance_at(device, scene, hits));
    for (size_t i = 0; i < hits.size(); ++i) {
      radiance.push_back(s.diffuse[i] + s.specular[i]);
      colors.push_back(radiance[i] + glow(hits[i]));
    }
  }
  std::vector<Hit> hits;
  std::vector<Vec3f> radiance, colors;  // without the glow, and with it
};

// Upper half: a layer's region.
EditLayer upper_half(const Scene& scene) {
  Region::Points points;
  const Mesh& mesh = scene.surface->mesh();
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    if (mesh.positions[v].z < 0) continue;
    points.positions.push_back(mesh.positions[v]);
    points.normals.push_back(mesh.normals[v]);
    points.reach.push_back(0.03f);
  }
  EditLayer layer;
  layer.id = "0001-material";
  layer.region = Region(points);
  layer.material.roughness = scene.material.mean().roughness;
  return layer;
}

struct ResidualTest : testing::Test {
  static void SetUpTestSuite() {
    scene = sphere_scene();
    const Photographed photographed(device, scene);
    Progress quiet;
    ResidualOptions options;
    options.steps = 250;
    scene.residual = std::make_shared<const Residual>(
        fit_residual(device, scene.sdf, {photographed.hits, photographed.colors, {}, {}},
                     photographed.radiance, options, quiet));
  }
  static Scene without() {
    Scene plain = scene;
    plain.residual = nullptr;
    return plain;
  }
  static Image picture(const Scene& s) {
    return shade_view(device, s, trace_view(device, s, camera_towards_origin({2.5, 1.5, 0.5}, 96), 1)).rgb;
  }
  static inline const Device device = make_device("cpu");
  static inline Scene scene;
};

TEST_F(ResidualTest, LearnsWhatThePhysicalModelLeavesAndHoldsInOtherViews) {
  const std::vector<Hit> hits = seen_from(device, scene, {2.2, 2.0, 0.3});
  const std::vector<Vec3f> got = residual_at(device, *scene.residual, hits);
  double error = 0, all = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    error += dot(got[i] - glow(hits[i]), got[i] - glow(hits[i]));
    all += dot(glow(hits[i]), glow(hits[i]));
  }
  EXPECT_LT(std::sqrt(error / all), 0.2);
}

// Without light and material the network is all of the color.
TEST_F(ResidualTest, AloneLearnsTheColorsThemselves) {
  Photographed lit(device, without());
  for (size_t i = 0; i < lit.hits.size(); ++i) lit.colors[i] = Vec3f{0.1f, 0.1f, 0.1f} + glow(lit.hits[i]);
  Progress quiet;
  ResidualOptions options;
  options.steps = 250;
  const Residual alone = fit_residual(device, scene.sdf, {lit.hits, lit.colors, {}, {}}, {}, options, quiet);
  const std::vector<Hit> hits = seen_from(device, scene, {2.2, 2.0, 0.3});
  const std::vector<Vec3f> got = residual_at(device, alone, hits);
  double error = 0, all = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    const Vec3f want = Vec3f{0.1f, 0.1f, 0.1f} + glow(hits[i]);
    error += dot(got[i] - want, got[i] - want);
    all += dot(want, want);
  }
  EXPECT_LT(std::sqrt(error / all), 0.2);
}

// Stripes that the distance field knows nothing of: its features are zero everywhere.
Vec3f stripes(const Hit& h) { return Vec3f{0.05f, 0.05f, 0.05f} * (1 + std::sin(40 * h.position.z)); }

TEST_F(ResidualTest, FeaturesLearnWhatTheDistanceFieldDoesNotKnow) {
  Scene tabled = without();
  FieldConfig config;
  config.encoding = {0, 6, 8, 64, 12};
  config.activation = Activation::softplus;
  config.outputs = 1 + 8;
  config.width = 32;
  config.sphere_radius = kSphereRadius;
  const auto sdf = std::make_shared<Field>(config, 1);
  std::vector<Param>& params = sdf->params().all();
  for (size_t k = params.size() - 2; k < params.size(); ++k)
    for (size_t i = 0; i < params[k].count(); ++i)
      if (k + 1 == params.size() || i < size_t(config.width)) params[k].value[i] = 0;  // exactly the sphere
  tabled.sdf = sdf;
  Photographed striped(device, tabled);
  for (size_t i = 0; i < striped.hits.size(); ++i)
    striped.colors[i] += stripes(striped.hits[i]) - glow(striped.hits[i]);
  const std::vector<Param> before = sdf->params().all();
  Progress quiet;
  ResidualOptions options;
  options.steps = 250;
  const Residual got = fit_residual(device, tabled.sdf, {striped.hits, striped.colors, {}, {}},
                                    striped.radiance, options, quiet);
  EXPECT_NE(got.features, tabled.sdf);
  for (size_t k = 0; k < before.size(); ++k) EXPECT_EQ(before[k].value, sdf->params().all()[k].value);
  const std::vector<Hit> hits = seen_from(device, tabled, {2.2, 2.0, 0.3});
  const std::vector<Vec3f> values = residual_at(device, got, hits);
  double error = 0, all = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    const Vec3f off = values[i] - stripes(hits[i]);
    error += dot(off, off);
    all += dot(stripes(hits[i]), stripes(hits[i]));
  }
  EXPECT_LT(std::sqrt(error / all), 0.25);
}

TEST_F(ResidualTest, StartsAsNothing) {
  const std::vector<Hit> hits = seen_from(device, scene, {3, 0, 0});
  for (const Vec3f r : residual_at(device, make_residual(scene.sdf, 1), hits)) EXPECT_EQ(dot(r, r), 0);
}

TEST_F(ResidualTest, IsWholeOutsideAnEditsRegionAndFollowsTheEditInside) {
  EditLayer rougher = upper_half(scene);
  rougher.material.roughness = 0.9f;
  const Scene edited = with_layer(scene, rougher);
  const Image glowing = picture(scene), got = picture(edited),
              plain = picture(with_layer(without(), rougher));
  int inside = 0, outside = 0, corrected = 0;
  const Frame marks =
      shade_view(device, edited, trace_view(device, edited, camera_towards_origin({2.5, 1.5, 0.5}, 96), 1));
  for (size_t i = 0; i < marks.edited.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      if (got.data[4 * i + 3] == 0) continue;
      if (!marks.edited[i]) {
        EXPECT_EQ(got.data[4 * i + c], glowing.data[4 * i + c]);
        ++outside;
      } else {
        corrected += got.data[4 * i + c] != plain.data[4 * i + c];
        ++inside;
      }
    }
  EXPECT_GT(outside, 1000);
  EXPECT_GT(inside, 1000);
  EXPECT_GT(corrected, inside / 2);
}

TEST_F(ResidualTest, IsBackWhereAnEditIsErased) {
  EditLayer paint = upper_half(scene), erase;
  paint.material = {};
  paint.albedo = std::make_shared<Field>(scene.albedo->config(), 9);
  erase.id = "0002-paint";
  erase.everywhere = erase.erase = true;
  const Scene painted = with_layer(scene, paint);
  EXPECT_NE(picture(painted).data, picture(scene).data);
  EXPECT_EQ(picture(with_layer(painted, erase)).data, picture(scene).data);
}

TEST_F(ResidualTest, IsGoneUnderAnotherLight) {
  EditLayer light;
  light.id = "0001-light";
  light.light = scene.light;
  EXPECT_FALSE(with_layer(scene, light).residual);
}

TEST_F(ResidualTest, IsKeptWithTheObject) {
  Tensors tensors;
  Json head;
  save_scene(scene, tensors, head);
  EXPECT_EQ(picture(load_scene(tensors, head)).data, picture(scene).data);
}

}  // namespace
}  // namespace cei3d
