// SPDX-License-Identifier: Apache-2.0
// Paint that has a material: gold leaf on a sphere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "core/base/error_of.h"
#include "core/base/json.h"
#include "core/math/color.h"
#include "engine/edit/change_report.h"
#include "engine/edit/paint.h"
#include "engine/render/render_cache.h"
#include "engine/render/scene_light.h"
#include "engine/render/sphere_scene.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;

constexpr int kSize = 64, kHalf = 10;
const Vec3f kGold{1.0f, 0.766f, 0.336f};
const Vec3f kRed{0.784f, 0.118f, 0.157f};  // sRGB

Camera front() { return camera_towards_origin({0, -3, 0.3}, kSize); }

// A square in the middle of the picture; alpha of its left and right half.
Scribble red_square(float left, float right) {
  Image s(kSize, kSize, 4);
  for (int y = kSize / 2 - kHalf; y < kSize / 2 + kHalf; ++y)
    for (int x = kSize / 2 - kHalf; x < kSize / 2 + kHalf; ++x) {
      for (int c = 0; c < 3; ++c) s.at(x, y)[c] = kRed[c];
      s.at(x, y)[3] = x < kSize / 2 ? left : right;
    }
  return {front(), s};
}

bool same_bits(Vec3f a, Vec3f b) { return std::memcmp(&a, &b, sizeof(Vec3f)) == 0; }

class PaintMaterialTest : public ::testing::Test {
 protected:
  PaintRequest request(float left = 1, float right = 1) const {
    PaintRequest r;
    r.scribbles = {red_square(left, right)};
    r.id = "0001-paint";
    r.material.roughness = 0.15f;
    r.material.metalness = 1.0f;
    return r;
  }
  Scene painted(const Scene& scene, const PaintRequest& r) {
    return with_layer(scene, paint(device_, scene, r, quiet_).layer);
  }
  Appearance at_all_vertices(const Scene& scene) const {
    return appearance_at(device_, scene, vertex_hits(scene.surface->mesh()));
  }

  const Device device_ = make_device();
  const Scene before_ = sphere_scene();
  Progress quiet_;
};

TEST_F(PaintMaterialTest, TheMaterialIsWhereThePaintIsAndTheRestKeepsItsBits) {
  PaintRequest plain = request();
  plain.material = {};
  const Scene with = painted(before_, request()), without = painted(before_, plain);
  const Appearance was = at_all_vertices(before_), color = at_all_vertices(without),
                   is = at_all_vertices(with);
  int inside = 0;
  for (size_t i = 0; i < is.albedo.size(); ++i) {
    const bool in = color.layer[i] == 0;
    inside += in;
    EXPECT_EQ(is.layer[i], color.layer[i]);
    EXPECT_TRUE(same_bits(is.albedo[i], color.albedo[i]));  // the scribble's colors stay
    EXPECT_EQ(is.material[i], in ? (Material{0.15f, was.material[i].specular, 1}) : was.material[i]);
  }
  EXPECT_GT(inside, 100);
  RenderCache frames(device_);
  for (const Vec3d center : {Vec3d{0, -3, 0.3}, Vec3d{1.5, -2.5, 1}, Vec3d{0.2, 3, 0.5}}) {
    const ChangeReport r =
        compare_views(device_, frames, before_, with, camera_towards_origin(center, kSize), 2);
    EXPECT_EQ(r.changed_outside, 0u);
    EXPECT_EQ(r.pixels_changed > 0, center.y < 0);
  }
}

TEST_F(PaintMaterialTest, AColorReplacesThatOfTheScribbleExactly) {
  PaintRequest r = request();
  r.color = kGold;
  const PaintResult result = paint(device_, before_, r, quiet_);
  EXPECT_EQ(result.report.max_error, 0);
  const Scene gold = with_layer(before_, result.layer);
  const Appearance was = at_all_vertices(before_), is = at_all_vertices(gold);
  int inside = 0;
  for (size_t i = 0; i < is.albedo.size(); ++i) {
    EXPECT_TRUE(same_bits(is.albedo[i], is.layer[i] == 0 ? kGold : was.albedo[i]));
    inside += is.layer[i] == 0;
  }
  EXPECT_GT(inside, 100);
  // It is stored like any other.
  Tensors tensors;
  Json head = Json::object();
  save_layer(result.layer, tensors, head);
  const Appearance again = at_all_vertices(with_layer(before_, load_layer(tensors, head)));
  for (size_t i = 0; i < is.albedo.size(); ++i) EXPECT_TRUE(same_bits(is.albedo[i], again.albedo[i]));
}

TEST_F(PaintMaterialTest, GoldOnPaintThatShinesByItselfIsLit) {
  PaintRequest shining = request();
  shining.material = {};
  shining.unlit = true;
  PaintRequest gold = request();
  gold.color = kGold;
  const Scene below = painted(before_, shining);
  const Appearance was = at_all_vertices(below), is = at_all_vertices(painted(below, gold));
  int inside = 0;
  for (size_t i = 0; i < is.unlit.size(); ++i) {
    if (is.layer[i] != 1) continue;
    EXPECT_EQ(was.unlit[i], 1);
    EXPECT_EQ(is.unlit[i], 0);
    ++inside;
  }
  EXPECT_GT(inside, 100);
}

TEST_F(PaintMaterialTest, SemiTransparentPaintHasItsMaterialFromOneHalfOn) {
  PaintRequest r = request(0.3f, 0.8f);
  r.color = kGold;
  const Scene after = painted(before_, r);
  const std::vector<Hit> hits = vertex_hits(after.surface->mesh());
  const Appearance was = at_all_vertices(before_), is = at_all_vertices(after);
  int thin = 0, thick = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    const float weight = after.layers[0].weight(hits[i].position, hits[i].normal);
    EXPECT_EQ(is.material[i].metalness, weight > 0.5f ? 1 : was.material[i].metalness);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(is.albedo[i][c], was.albedo[i][c] * (1 - weight) + kGold[c] * weight, 1e-6f);
    thin += weight > 0 && weight <= 0.5f;
    thick += weight > 0.5f;
  }
  EXPECT_GT(thin, 20);
  EXPECT_GT(thick, 20);
  const PaintRequest veil = request(0.3f, 0.3f);
  EXPECT_THAT(error_of([&] { paint(device_, before_, veil, quiet_); }).what(), HasSubstr("more opaque"));
}

// The color is solved for with the new material, under which the view shows it.
TEST_F(PaintMaterialTest, TheViewShowsThePaintedColorInTheNewMaterial) {
  const SceneLight light(device_, before_, scene_transports(before_));
  PaintRequest r = request();
  const Vec3f dim{0.35f, 0.3f, 0.4f};  // sRGB
  for (size_t i = 0; i < r.scribbles[0].image.data.size(); ++i)
    if (i % 4 < 3) r.scribbles[0].image.data[i] = dim[int(i % 4)];
  r.material = {.roughness = 0.9f, .specular = 0.1f};
  r.seen_in = &light;
  const PaintResult result = paint(device_, before_, r, quiet_);
  EXPECT_EQ(result.report.out_of_reach, 0);
  const Scene seen = with_layer(before_, result.layer);
  const Frame f = shade_view(device_, seen, trace_view(device_, seen, front(), 2));
  for (int y = kSize / 2 - kHalf + 2; y < kSize / 2 + kHalf - 2; ++y)
    for (int x = kSize / 2 - kHalf + 2; x < kSize / 2 + kHalf - 2; ++x)
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(f.rgb.at(x, y)[c], linear_from_srgb(dim)[c], 0.01f);
}

TEST_F(PaintMaterialTest, WhatMakesNoSenseIsRefused) {
  PaintRequest r = request();
  r.routing = Routing::none;
  EXPECT_EQ(error_of([&] { paint(device_, before_, r, quiet_); }).code(), ErrorCode::usage);
  r = request();
  r.material.metalness = 1.5f;
  EXPECT_EQ(error_of([&] { paint(device_, before_, r, quiet_); }).code(), ErrorCode::usage);
}

}  // namespace
}  // namespace cei3d
