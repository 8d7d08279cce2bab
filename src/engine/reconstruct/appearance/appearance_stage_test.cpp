// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/appearance_stage.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/color.h"
#include "engine/reconstruct/appearance/test_drawn.h"
#include "engine/render/render.h"
#include "engine/render/scene_light.h"
#include "engine/render/sphere_scene.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

// Root mean square over the hits.
double difference(const Device& device, const Field& a, const Field& b, const std::vector<Hit>& hits) {
  std::vector<Vec3f> x;
  for (const Hit& h : hits) x.push_back(h.position);
  std::vector<float> of_a(3 * x.size()), of_b(3 * x.size());
  a.eval(device, x, of_a);
  b.eval(device, x, of_b);
  double sum = 0;
  for (size_t i = 0; i < of_a.size(); ++i) sum += (of_a[i] - of_b[i]) * (of_a[i] - of_b[i]);
  return std::sqrt(sum / double(of_a.size()));
}

// Shading of a known albedo, and back.
TEST(RefineAlbedo, FindsTheAlbedoBehindShadedPixels) {
  const Device device = make_device("cpu");
  const Scene scene = sphere_scene();
  const auto seen_from = [&](double turn) {
    const Vec3d center{3 * std::cos(turn), 3 * std::sin(turn), 0.5};
    return trace_view(device, scene, camera_towards_origin(center, 96), 1).hits;
  };
  std::vector<Hit> hits;
  for (int v = 0; v < 6; ++v)
    for (const Hit& h : seen_from(1.047 * v)) hits.push_back(h);
  const Shading shading =
      SceneLight(device, scene, scene_transports(scene)).shade(hits, appearance_at(device, scene, hits));
  std::vector<Vec3f> colors;
  for (size_t i = 0; i < hits.size(); ++i) colors.push_back(shading.diffuse[i] + shading.specular[i]);

  AppearanceOptions options;
  options.albedo = scene.albedo->config();
  AppearanceResult result;
  result.light = scene.light;
  result.material = scene.material.mean();
  result.albedo = std::make_shared<const Field>(options.albedo, 77);
  const double before = difference(device, *result.albedo, *scene.albedo, hits);
  Progress quiet;
  refine_albedo(device, {scene.surface, {hits, colors, {}, {}}}, options, result, quiet, 150);
  EXPECT_GT(before, 0.03);
  EXPECT_LT(difference(device, *result.albedo, *scene.albedo, seen_from(0.5)), 0.25 * before);
}

AppearanceOptions brief(float roughness) {
  AppearanceOptions o;
  o.albedo.encoding = {0, 8, 8, 64, 12};
  o.albedo.width = 16;
  o.albedo.output_activation = Activation::sigmoid;
  o.effort = Effort::brief;
  o.roughness = roughness;
  o.albedo_steps = 150;
  o.refine_steps = 12;
  return o;
}

// What the object of the result looks like where the drawn one was seen.
std::vector<Vec3f> redrawn(const Device& device, const Drawn& d, const AppearanceResult& a) {
  std::vector<Vec3f> x;
  for (const Hit& h : d.hits) x.push_back(h.position);
  const Lighting lighting(device, d.surface, a.light, a.split.albedo, a.material.mean(), d.transport);
  const Shading s = lighting.shade(UniformBatch(d.hits, a.material.mean()), a.albedo->eval3(device, x));
  std::vector<Vec3f> out(x.size());
  for (size_t i = 0; i < x.size(); ++i) out[i] = s.diffuse[i] + s.specular[i];
  return out;
}

TEST(AppearanceStage, ExplainsThePicturesAndGivesTheSameBitsTwice) {
  const Drawn d = draw({0.3f, 0.5f, 0});
  const AppearanceOptions o = brief(0.3f);
  Progress quiet;
  const Device device = make_device();
  const AppearanceResult a = fit_appearance(device, {d.surface, d.samples()}, o, quiet);
  const std::vector<Vec3f> got = redrawn(device, d, a);
  double error = 0, total = 0;
  for (size_t i = 0; i < got.size(); ++i) {
    const Vec3f e = got[i] - d.colors[i];
    error += dot(e, e);
    total += dot(d.colors[i], d.colors[i]);
  }
  EXPECT_LT(std::sqrt(error / total), 0.08);
  const AppearanceResult b = fit_appearance(device, {d.surface, d.samples()}, o, quiet);
  EXPECT_EQ(to_array(a.light), to_array(b.light));
  for (size_t i = 0; i < a.albedo->params().all().size(); ++i)
    EXPECT_EQ(a.albedo->params().all()[i].value, b.albedo->params().all()[i].value);
}

TEST(AppearanceStage, TakesTheShareOfItsStepsThatThereIsTimeFor) {
  const Drawn d = draw({0.3f, 0.5f, 0});
  AppearanceOptions o = brief(0.3f);
  o.albedo_steps = 8;
  o.refine_steps = 3;
  o.lobe_steps = 1;
  int steps = 0;
  o.show = [&](const Lighting&, const Field&, const MaterialField&) { ++steps; };
  Progress quiet;
  for (const auto& [share, expected] : {std::pair{1.0, 11}, {0.5, 6}, {0.01, 2}}) {
    steps = 0;
    o.descent_share = share;
    fit_appearance(make_device(), {d.surface, d.samples()}, o, quiet);
    EXPECT_EQ(steps, expected);
  }
}

// Where a picture clips red, green and blue still tell the light's color, and the darker stripes, which
// mirror the same light unclipped, its strength.
TEST(AppearanceStage, TakesClippedChannelsForLowerBounds) {
  constexpr float kWhite = 0.7f;
  Drawn d = draw({0.3f, 0.5f, 1});
  const std::vector<Vec3f> truth = d.colors;
  std::vector<size_t> red;  // samples of which nothing but red is clipped
  for (size_t i = 0; i < truth.size(); ++i) {
    uint8_t bits = 0;
    for (int c = 0; c < 3; ++c) {
      if (truth[i][c] < kWhite) continue;
      bits |= uint8_t(1 << c);
      d.colors[i][c] = kWhite;
    }
    d.clipped.push_back(bits);
    if (bits == 1) red.push_back(i);
  }
  ASSERT_GT(red.size(), 200u);
  Progress quiet;
  const Device device = make_device();
  AppearanceOptions options = brief(0.3f);
  options.refine_steps = 50;  // after fewer, colors still move
  const auto means = [&] {
    const std::vector<Vec3f> got =
        redrawn(device, d, fit_appearance(device, {d.surface, d.samples()}, options, quiet));
    Vec3f mean{0, 0, 0};
    for (const size_t i : red) mean += got[i] / truth[i] / float(red.size());
    return mean;
  };
  const Vec3f bounded = means();
  d.clipped.clear();  // as if the pictures were right
  const Vec3f believed = means();
  EXPECT_LT(std::abs(bounded.x - 1), 0.5f * std::abs(believed.x - 1));
  EXPECT_GT(bounded.x, 0.88f);
  EXPECT_NEAR(bounded.y, 1, 0.07);
  EXPECT_NEAR(bounded.z, 1, 0.07);
}

}  // namespace
}  // namespace cei3d
