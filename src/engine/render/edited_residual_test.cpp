// SPDX-License-Identifier: Apache-2.0
// The correction in the regions of edits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "engine/render/random_residual.h"
#include "engine/render/render.h"
#include "engine/render/sphere_scene.h"

namespace cei3d {
namespace {

constexpr int kSize = 40;

std::shared_ptr<const Field> uniform_field(Vec3f color) {
  FieldConfig c;
  c.hidden_layers = 0;
  auto field = std::make_shared<Field>(c, 0);
  for (Param& p : field->params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  for (int i = 0; i < 3; ++i) field->params().all().back().value[size_t(i)] = color[i];
  return field;
}

// A sphere of one albedo with a correction that is not zero.
Scene corrected_sphere() {
  Scene s = sphere_scene();
  s.residual = random_residual(*s.albedo, 0.1f);
  s.albedo = uniform_field({0.4f, 0.3f, 0.2f});
  return s;
}

EditLayer everywhere() {
  EditLayer l;
  l.id = "0001-edit";
  l.everywhere = true;
  return l;
}

Frame frame_of(const Scene& scene) {
  const Device device = make_device();
  return shade_view(device, scene, trace_view(device, scene, camera_towards_origin({1, -3, 0.4}, kSize), 1));
}

bool same_colors(const Frame& a, const Frame& b) { return a.rgb.data == b.rgb.data; }

TEST(EditedResidual, AnEditThatChangesNothingChangesNoBit) {
  const Scene scene = corrected_sphere();
  const Frame before = frame_of(scene);
  EditLayer paint = everywhere();
  paint.albedo = scene.albedo;
  EXPECT_TRUE(same_colors(frame_of(with_layer(scene, paint)), before));
  EditLayer material = everywhere();
  material.material.roughness = scene.material.mean().roughness;
  material.material.metalness = scene.material.mean().metalness;
  EXPECT_TRUE(same_colors(frame_of(with_layer(scene, material)), before));
  paint.albedo = uniform_field({0.1f, 0.1f, 0.1f});
  EditLayer erase = everywhere();
  erase.erase = true;
  EXPECT_TRUE(same_colors(frame_of(with_layer(with_layer(scene, paint), erase)), before));
  Scene without = scene;
  without.residual = nullptr;
  EXPECT_FALSE(same_colors(frame_of(without), before));
}

// The correction of a pixel relative to what light and material give is the same before and after.
TEST(EditedResidual, StaysTheSameShareOfTheRadiance) {
  const Scene scene = corrected_sphere();
  const auto share = [](const Frame& f, size_t pixel, size_t c) {
    const float explained = f.diffuse.data[4 * pixel + c] + f.specular.data[4 * pixel + c];
    return f.rgb.data[4 * pixel + c] / explained - 1;
  };
  EditLayer darker = everywhere(), rougher = everywhere();
  darker.tint = Tint{{0.2f, 0.1f, 0.15f}, false, {1, 1, 1}};
  rougher.material.roughness = 0.9f;
  const Frame before = frame_of(scene);
  for (const EditLayer& edit : {darker, rougher}) {
    const Frame after = frame_of(with_layer(scene, edit));
    size_t pixels = 0;
    for (size_t p = 0; p < before.mask.data.size(); ++p)
      for (size_t c = 0; c < 3; ++c) {
        const float was = share(before, p, c), now = after.mask.data[p] > 0 ? share(after, p, c) : 0;
        const float brighter = (after.diffuse.data[4 * p + c] + after.specular.data[4 * p + c]) /
                               (before.diffuse.data[4 * p + c] + before.specular.data[4 * p + c]);
        if (!(before.mask.data[p] == 1 && was > -0.9f && brighter < 1.9f)) continue;
        EXPECT_NEAR(now, was, 0.02f + 0.05f * std::abs(was)) << p;
        ++pixels;
      }
    EXPECT_GT(pixels, 300u);
  }
}

TEST(EditedResidual, StaysBehindWhereSurfaceBecomesMuchBrighter) {
  Scene scene = corrected_sphere();
  scene.albedo = uniform_field({0.02f, 0.02f, 0.02f});
  Scene without = scene;
  without.residual = nullptr;
  EditLayer white = everywhere();
  white.albedo = uniform_field({0.8f, 0.8f, 0.8f});
  const Frame before = frame_of(scene), bare = frame_of(without), after = frame_of(with_layer(scene, white)),
              bare_after = frame_of(with_layer(without, white));
  for (size_t i = 0; i < before.rgb.data.size(); ++i) {
    if (i % 4 == 3) continue;
    const float was = std::abs(before.rgb.data[i] - bare.rgb.data[i]);
    // Bounded radiance below zero makes the correction of the dark sphere look smaller than it is.
    if (before.rgb.data[i] > 0) {
      EXPECT_LE(std::abs(after.rgb.data[i] - bare_after.rgb.data[i]), 2.2f * was + 0.02f);
    }
  }
}

// The sphere with one picture of the correction: columns of pixels that are brighter and darker by turns, and
// brighter by .05 on average.
Scene striped_sphere(const Camera& camera) {
  Scene s = sphere_scene();
  const Device device = make_device();
  const GBuffer g = trace_view(device, s, camera, 1);
  std::vector<std::array<uint16_t, 2>> pixels;
  std::vector<Vec3f> differences;
  std::vector<float> distances;
  for (int p = 0; p < g.width * g.height; ++p)
    for (uint32_t i = g.pixel_start[size_t(p)]; i < g.pixel_start[size_t(p) + 1]; ++i) {
      pixels.push_back({uint16_t(p % g.width), uint16_t(p / g.width)});
      const float v = p % g.width % 2 ? 0.15f : -0.05f;
      differences.push_back({v, v, v});
      distances.push_back(length(g.hits[i].position - to_float(camera.center)));
    }
  Residual r;
  r.images = std::make_shared<const ResidualImages>(
      std::vector<ResidualImage>{ResidualImage(camera, pixels, differences, distances)});
  s.residual = std::make_shared<const Residual>(std::move(r));
  s.albedo = uniform_field({0.4f, 0.4f, 0.4f});
  return s;
}

// Largest step of the correction between neighboring pixels in the middle of the image; mean: of itself.
float largest_step(const Frame& with, const Frame& without, double& mean) {
  float largest = 0;
  const int n = with.rgb.width;
  for (int y = n * 2 / 5; y < n * 3 / 5; ++y)
    for (int x = n * 2 / 5; x < n * 3 / 5; ++x) {
      const auto correction = [&](int at) { return with.rgb.at(at, y)[1] - without.rgb.at(at, y)[1]; };
      largest = std::max(largest, std::abs(correction(x + 1) - correction(x)));
      mean += correction(x) / double(square(n * 3 / 5 - n * 2 / 5));
    }
  return largest;
}

// What the photographs show of the old surface is not seen on paint; that light and material make the surface
// too dark still is corrected. A tint keeps what is below.
TEST(EditedResidual, OnPaintItHasNoDetails) {
  const Device device = make_device();
  const Camera camera = camera_towards_origin({1, -3, 0.4}, 200);
  const Scene scene = striped_sphere(camera);
  Scene without = scene;
  without.residual = nullptr;
  const Vec3f color{0.3f, 0.45f, 0.45f};
  EditLayer paint = everywhere(), tint = everywhere(), flat = everywhere();
  paint.albedo = uniform_field(color);
  tint.tint = Tint{color, true, {0.4f, 0.4f, 0.4f}};
  flat.tint = Tint{color, false};
  const GBuffer g = trace_view(device, scene, camera, 1);
  const auto step = [&](const EditLayer& edit, double& mean) {
    return largest_step(shade_view(device, with_layer(scene, edit), g),
                        shade_view(device, with_layer(without, edit), g), mean);
  };
  double painted = 0, flattened = 0, tinted = 0;
  EXPECT_LT(step(paint, painted), 0.01f);
  EXPECT_LT(step(flat, flattened), 0.01f);
  EXPECT_GT(step(tint, tinted), 0.04f);
  EXPECT_NEAR(painted, tinted, 0.15 * tinted);
  EXPECT_NEAR(flattened, painted, 1e-3);
}

TEST(EditedResidual, IsNotOnPaintThatShowsWithoutLight) {
  const Scene scene = corrected_sphere();
  EditLayer sign = everywhere();
  sign.albedo = uniform_field({0.5f, 0.6f, 0.7f});
  sign.unlit = true;
  const Frame f = frame_of(with_layer(scene, sign));
  for (size_t p = 0; p < f.mask.data.size(); ++p)
    if (f.mask.data[p] > 0) {
      EXPECT_NEAR(f.rgb.data[4 * p + 1], 0.6f, 1e-5f);
    }
}

}  // namespace
}  // namespace cei3d
