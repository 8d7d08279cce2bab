// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/appearance/appearance_stage.h"

#include <gtest/gtest.h>

#include <cmath>

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

// Shading of a known base color, and back.
TEST(RefineAlbedo, FindsTheBaseColorBehindShadedPixels) {
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

}  // namespace
}  // namespace cei3d
