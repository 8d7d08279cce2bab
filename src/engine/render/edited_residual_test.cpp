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
