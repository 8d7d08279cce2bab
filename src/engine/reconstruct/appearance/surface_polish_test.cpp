// SPDX-License-Identifier: Apache-2.0
// A metal ball, drawn by path tracing: whether normals come nearer to its own when they learn from what it
// mirrors.
#include "engine/reconstruct/appearance/surface_polish.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/color.h"
#include "core/math/fibonacci.h"
#include "engine/reconstruct/start/start.h"
#include "engine/render/render.h"
#include "engine/render/sphere_scene.h"
#include "engine/synthetic/picture.h"
#include "model/geometry/mesh/surface_nets.h"

namespace cei3d {
namespace {

constexpr int kSize = 64, kViews = 16;
const Material kMetal{0.2f, 0.5f, 1};

// Albedo 0.5 everywhere: a network without weights.
std::shared_ptr<const Field> gray_field() {
  FieldConfig c;
  c.encoding.levels = 4;
  c.output_activation = Activation::sigmoid;
  auto field = std::make_shared<Field>(c, 1);
  for (Param& p : field->params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  return field;
}

SgMixture room() {
  return {{{normalize(Vec3f{1, 0.4f, 1}), 60, {1.5f, 1, 0.5f}},
           {normalize(Vec3f{-1, 1, 0.3f}), 40, {0.3f, 0.6f, 1.2f}},
           {normalize(Vec3f{0.2f, -1, -0.5f}), 60, {0.5f, 1, 0.5f}},
           {{0, 0, 1}, 1.5f, {0.4f, 0.4f, 0.4f}}}};
}

Camera camera_of(int view) {
  return camera_towards_origin(to_double(fibonacci_direction(view, kViews)) * 3.0, kSize);
}

PixelStore pictures() {
  SyntheticScene ball;
  ball.shape = ball_shape(kSphereRadius);
  ball.finishes.assign(ball.shape.regions.size(), {kMetal, {0.5f, 0.5f, 0.5f}});
  ball.light = room();
  PixelStore store;
  for (int view = 0; view < kViews; ++view) {
    const Camera camera = camera_of(view);
    store.add_view(camera, draw(ball, camera, {.samples = 64, .view = uint64_t(view)}).color, 3);
  }
  return store;
}

GeometryOptions small_geometry() {
  GeometryOptions o;
  o.sdf.encoding = {0, 6, 8, 64, 12};
  o.sdf.hidden_layers = 1;
  o.sdf.width = 32;
  o.sdf.activation = Activation::softplus;
  o.sdf.outputs = 9;
  o.sdf.sphere_radius = 0.5f;
  o.radiance_width = 32;
  o.rays = 512;
  return o;
}

struct ObservedSurface {
  std::shared_ptr<const Surface> surface;
  std::vector<Hit> hits;
  std::vector<Vec3f> colors;
};

ObservedSurface observed_surface(const Device& device, const Field& sdf, const PixelStore& pixels) {
  ObservedSurface s{std::make_shared<const Surface>(extract_mesh(device, sdf, {64})), {}, {}};
  std::vector<Ray> rays;
  std::vector<Vec3f> colors;
  for (const Pixel& p : pixels.pixels()) {
    if (p.srgba[3] < 255) continue;
    rays.push_back(pixels.cameras()[p.view].ray(p.x + 0.5, p.y + 0.5));
    colors.push_back({linear_from_srgb(float(p.srgba[0]) / 255), linear_from_srgb(float(p.srgba[1]) / 255),
                      linear_from_srgb(float(p.srgba[2]) / 255)});
  }
  std::vector<uint32_t> ray_of_hit;
  s.hits = trace_rays(device, sdf, *s.surface, rays, ray_of_hit);
  for (const uint32_t r : ray_of_hit) s.colors.push_back(colors[r]);
  return s;
}

// Mean angle between the hits' normals and the ball's own, degrees.
double normal_error(const Device& device, const Field& sdf, const PixelStore& pixels) {
  const ObservedSurface s = observed_surface(device, sdf, pixels);
  double sum = 0;
  for (const Hit& h : s.hits) sum += std::acos(std::min(dot(h.normal, normalize(h.position)), 1.0f));
  return sum / double(s.hits.size()) * 180 / M_PI;
}

TEST(SurfacePolish, BringsNormalsNearerToTheTruthThanTheSameStepsWithoutIt) {
  const Device device = make_device("cpu");
  const PixelStore pixels = pictures();
  GeometryStage stage(device, pixels, small_geometry(), 1);
  stage.prefit(start_shape(pixels, Start::hull, 1));
  for (int step = 0; step < 150; ++step) stage.step(step, 0.66 * step / 150);
  Tensors before;
  stage.save(before);

  const ObservedSurface seen = observed_surface(device, stage.sdf(), pixels);
  const AppearanceInput input{seen.surface, {seen.hits, seen.colors, {}}};
  AppearanceResult look;
  look.light = room();
  look.material = kMetal;
  look.albedo = gray_field();
  PolishOptions options;
  options.steps = 80;
  options.batch = 2048;
  Progress silent;
  double error[2];
  for (const bool polished : {false, true}) {
    stage.load(before);
    options.weight = polished ? 1 : 0;
    polish_surface(device, stage, input, look, options, silent);
    error[polished] = normal_error(device, stage.sdf(), pixels);
  }
  EXPECT_LT(error[1], 0.93 * error[0]) << "without: " << error[0] << " degrees";
}

}  // namespace
}  // namespace cei3d
