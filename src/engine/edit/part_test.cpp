// SPDX-License-Identifier: Apache-2.0
// Parts of a sphere: a cap of another color, which one view shows half of.
#include "engine/edit/part.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/error_of.h"
#include "core/math/color.h"
#include "core/math/ray_sphere.h"
#include "core/math/rng.h"
#include "engine/render/sphere_scene.h"
#include "model/scene/appearance.h"
#include "model/scene/parts.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;

constexpr float kSpacing = 0.03f, kTop = 0.2f;
constexpr int kSize = 96;

HandlerPoints handler_points() {
  std::vector<Hit> hits;
  for (int i = 0; i < 60000; ++i) {
    Rng rng(5, 0, i);
    const Vec3f n = normalize(Vec3f{rng.normal(), rng.normal(), rng.normal()});
    hits.push_back({n * kSphereRadius, n, n, 0, 0, 0});
  }
  return thin_hits(hits, std::vector<float>(hits.size(), kSpacing), kSpacing);
}

// Scores cross one half where depth does zero.
Region region_of(const HandlerPoints& points, const std::function<float(Vec3f)>& depth) {
  ScoredPoints::Data d{points.positions, points.normals, {}, points.spacing};
  for (const Vec3f p : points.positions)
    d.scores.push_back(clamp(0.5f + depth(p) / (2 * kSpacing), 0.0f, 1.0f));
  return Region{ScoredPoints(d)};
}

float cap(Vec3f p) { return p.z - kTop; }

class PartTest : public ::testing::Test {
 protected:
  void SetUp() override {
    scene_ = sphere_scene();
    scene_.handlers = std::make_shared<HandlerPoints>(handler_points());
    EditLayer red;
    red.id = "0001-material";
    red.region = region_of(*scene_.handlers, cap);
    red.tint = Tint{{0.7f, 0.15f, 0.1f}, false, {1, 1, 1}};
    scene_ = with_layer(scene_, red);
  }

  PartRequest request() const {
    PartRequest r;
    r.id = "0002-part";
    r.name = "cap";
    r.view = "train/r_0";
    r.camera = camera_towards_origin({0, -3, 0.3}, kSize);
    return r;
  }
  PartRequest clicked() const {
    PartRequest r = request();
    r.clicks.positive = {pixel({0.1f, -0.4f, 0.5f})};
    r.clicks.negative = {pixel({0, -0.69f, -0.1f})};
    return r;
  }
  Vec2f pixel(Vec3f direction) const {
    const Vec3d p = request().camera.project(to_double(normalize(direction) * kSphereRadius));
    return {float(p.x), float(p.y)};
  }
  PartResult select(const PartRequest& r) { return select_part(device_, scene_, r, quiet_); }
  // Share of the vertices farther than a spacing from the border that are on the right side of it.
  double right_share(const EditLayer& layer, const std::function<float(Vec3f)>& depth) const {
    const std::vector<Hit> hits = vertex_hits(scene_.surface->mesh());
    const std::vector<uint8_t> inside = inside_layer(scene_, layer, hits);
    int right = 0, all = 0;
    for (size_t i = 0; i < hits.size(); ++i) {
      const float d = depth(hits[i].position);
      if (std::abs(d) < kSpacing) continue;
      right += inside[i] == (d > 0);
      ++all;
    }
    return double(right) / all;
  }
  std::string refusal(const PartRequest& r, ErrorCode code) {
    try {
      select(r);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), code) << e.what();
      return e.what();
    }
    return "no error";
  }

  const Device device_ = make_device();
  Scene scene_;
  Progress quiet_;
};

TEST_F(PartTest, ClicksInOneViewSelectThePartAllAround) {
  const PartResult result = select(clicked());
  EXPECT_EQ(result.layer.part, "cap");
  EXPECT_GT(right_share(result.layer, cap), 0.995);
  EXPECT_GT(result.report.points, 0u);
}

TEST_F(PartTest, InOneViewOnlyEndsWhereTheViewDoes) {
  PartRequest r = clicked();
  r.in_view = true;
  const Vec3f eye = to_float(r.camera.center);
  const auto seen_cap = [&](Vec3f p) {  // in lengths: how far from the cap's border and from the limb
    return min(cap(p), kSphereRadius * (dot(normalize(p), normalize(eye - p)) - 0.1f));
  };
  const PartResult all = select(clicked()), seen = select(r);
  EXPECT_GT(right_share(seen.layer, seen_cap), 0.98);
  EXPECT_LT(seen.report.share, 0.7 * all.report.share);
}

// A stroke along a row of pixels that shows the cap, and one that shows the rest.
Image stroke(int row, int x0, int x1, Vec3f srgb) {
  Image rgba(kSize, kSize, 4);
  for (int y = row - 1; y <= row + 1; ++y)
    for (int x = x0; x < x1; ++x) {
      for (int c = 0; c < 3; ++c) rgba.at(x, y)[c] = srgb[c];
      rgba.at(x, y)[3] = 1;
    }
  return rgba;
}

TEST_F(PartTest, AStrokeSelectsThePartAndGivesItItsColor) {
  PartRequest r = request();
  const int on_cap = int(pixel({0, -0.4f, 0.5f}).y), below = int(pixel({0, -0.7f, -0.1f}).y);
  const Vec3f green{0.2f, 0.8f, 0.4f};
  r.scribble = part_scribble(stroke(on_cap, 40, 56, green), stroke(below, 30, 66, green), std::nullopt);
  const PartResult result = select(r);
  EXPECT_GT(right_share(result.layer, cap), 0.995);
  ASSERT_TRUE(result.layer.tint);
  EXPECT_NEAR(length(result.layer.tint->color - linear_from_srgb(green)), 0, 1e-5);
  r.keep_color = true;
  EXPECT_FALSE(select(r).layer.tint);
  r.keep_color = false;
  r.color = Vec3f{1, 0, 0};
  EXPECT_EQ(select(r).layer.tint->color.x, 1);
}

TEST_F(PartTest, APatternIsContinuedOverThePart) {
  PartRequest r = request();
  const int on_cap = int(pixel({0, -0.4f, 0.5f}).y);
  Image rgba = stroke(on_cap, 40, 56, {0.2f, 0.2f, 0.2f});
  for (int y = on_cap - 1; y <= on_cap + 1; ++y)
    for (int x = 40; x < 48; ++x) rgba.at(x, y)[0] = 0.9f;  // left half red, right half dark
  r.scribble = part_scribble(rgba, {}, std::nullopt);
  EXPECT_EQ(r.scribble->tile.width, 16);
  EXPECT_EQ(r.scribble->tile.height, 3);
  r.network = [](const Scene& scene, const PartRequest&, Progress&) {
    std::vector<float> scores;
    for (const Vec3f p : scene.handlers->positions)
      scores.push_back(clamp(0.5f + cap(p) / (2 * kSpacing), 0.0f, 1.0f));
    return scores;
  };
  const EditLayer layer = select(r).layer;
  ASSERT_TRUE(layer.albedo);
  // Columns 32 to 40 mirror the red half, columns 56 to 64 the dark one; rows repeat it.
  const auto red_at = [&](float column, float row) {
    const Ray ray = r.camera.ray(column, row);
    const Vec3f p = ray.origin + ray.direction * sphere_span(ray, kSphereRadius).near;
    return layer.albedo->eval3(device_, std::vector{p})[0].x;
  };
  for (const float row : {float(on_cap) - 3.5f, float(on_cap) + 0.5f}) {
    for (const float column : {36.0f, 44.0f})
      EXPECT_NEAR(red_at(column, row), linear_from_srgb(0.9f), 0.1) << column << ' ' << row;
    for (const float column : {52.0f, 60.0f})
      EXPECT_NEAR(red_at(column, row), linear_from_srgb(0.2f), 0.1) << column << ' ' << row;
  }
  r.keep_texture = true;
  EXPECT_THAT(refusal(r, ErrorCode::usage), HasSubstr("pattern"));
}

TEST_F(PartTest, WrongScribblesSaySo) {
  PartRequest r = request();
  const auto scribble = [&](const Image& rgba, std::optional<Vec3f> beside = {}) {
    r.scribble = part_scribble(rgba, {}, beside);
    return r;
  };
  const Vec3f blue{0, 0, 1};
  EXPECT_THAT(refusal(scribble(stroke(2, 1, 5, blue)), ErrorCode::failed),
              HasSubstr("nothing of the object"));
  r.scribble->positive = Image(kSize, kSize / 2, 1);
  EXPECT_THAT(refusal(r, ErrorCode::usage), HasSubstr("view's own size"));
  const Image on = stroke(kSize / 2, 40, 50, blue);
  r.scribble = part_scribble(on, on, std::nullopt);
  EXPECT_THAT(refusal(r, ErrorCode::usage), HasSubstr("cover"));
  EXPECT_THAT(error_of([&] { scribble(Image(kSize, kSize, 4)); }).what(), HasSubstr("no stroke"));
  EXPECT_THAT(error_of([&] { scribble(Image(kSize, kSize, 3)); }).what(), HasSubstr("alpha"));
  EXPECT_THAT(error_of([&] { scribble(on, linear_from_srgb(blue)); }).what(), HasSubstr("negative color"));
}

TEST_F(PartTest, AMaskSelectsTheSame) {
  PartRequest r = request();
  r.mask = Image(kSize, kSize, 1);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const Ray ray = r.camera.ray(x + 0.5, y + 0.5);
      const auto [near, far] = sphere_span(ray, kSphereRadius);
      if (near < far && cap(ray.origin + ray.direction * near) > 0) *r.mask.at(x, y) = 1;
    }
  EXPECT_GT(right_share(select(r).layer, cap), 0.995);
}

TEST_F(PartTest, CombinesWithAPartThatThereIs) {
  const auto right_half = [](Vec3f p) { return p.x; };
  EditLayer half;
  half.id = "0002-part";
  half.part = "half";
  half.region = region_of(*scene_.handlers, right_half);
  scene_ = with_layer(scene_, half);
  PartRequest r = clicked();
  using How = PartCombination::How;
  const auto combined = [&](How how) {
    r.combination = PartCombination{how, "half"};
    return select(r).layer;
  };
  EXPECT_GT(right_share(combined(How::add), [&](Vec3f p) { return std::max(right_half(p), cap(p)); }), 0.99);
  EXPECT_GT(right_share(combined(How::subtract), [&](Vec3f p) { return std::min(right_half(p), -cap(p)); }),
            0.99);
  EXPECT_GT(right_share(combined(How::intersect), [&](Vec3f p) { return std::min(right_half(p), cap(p)); }),
            0.99);
}

TEST_F(PartTest, EffectsStayInThePart) {
  PartRequest r = clicked();
  r.color = Vec3f{0.1f, 0.2f, 0.8f};
  r.change.roughness = 0.9f;
  const std::vector<Hit> hits = vertex_hits(scene_.surface->mesh());
  const Appearance before = appearance_at(device_, scene_, hits);
  const Scene edited = with_layer(scene_, select(r).layer);
  const Appearance after = appearance_at(device_, edited, hits);
  for (size_t i = 0; i < hits.size(); ++i) {
    const float d = cap(hits[i].position);
    if (d > 2 * kSpacing) {
      EXPECT_EQ(after.albedo[i].z, 0.8f);
      EXPECT_EQ(after.material[i].roughness, 0.9f);
    } else if (d < -2 * kSpacing) {
      EXPECT_EQ(after.albedo[i].x, before.albedo[i].x);
      EXPECT_EQ(after.material[i].roughness, scene_.material.mean().roughness);
    }
  }
  r.keep_texture = true;  // the cap is of one color: its mean becomes the new one
  const EditLayer layer = select(r).layer;
  EXPECT_NEAR(layer.tint->mean.x, 0.7f, 0.02f);
  EXPECT_NEAR(layer.tint->mean.z, 0.1f, 0.02f);
}

TEST_F(PartTest, TakesTheScoresOfANetwork) {
  PartRequest r = clicked();
  r.network = [](const Scene& scene, const PartRequest&, Progress&) {
    std::vector<float> scores;
    for (const Vec3f p : scene.handlers->positions) scores.push_back(p.x > 0 ? 1.0f : 0.0f);
    return scores;
  };
  EXPECT_GT(right_share(select(r).layer, [](Vec3f p) { return p.x; }), 0.995);
}

TEST_F(PartTest, WrongClicksSaySo) {
  PartRequest r = request();
  EXPECT_THAT(refusal(r, ErrorCode::usage), HasSubstr("positive click"));
  r.clicks.positive = {{1, 1}};
  EXPECT_THAT(refusal(r, ErrorCode::failed), HasSubstr("background"));
  r.clicks.positive = {{1, float(kSize + 1)}};
  EXPECT_THAT(refusal(r, ErrorCode::usage), HasSubstr("not in view"));
  r.clicks.positive = {{NAN, 3}};
  EXPECT_THAT(refusal(r, ErrorCode::usage), HasSubstr("not in view"));
  r = clicked();
  r.clicks.negative = r.clicks.positive;
  EXPECT_THAT(refusal(r, ErrorCode::usage), HasSubstr("same point"));
  r = clicked();
  r.combination = PartCombination{PartCombination::How::add, "ear"};
  EXPECT_THAT(refusal(r, ErrorCode::usage), HasSubstr("no part 'ear'"));
  r = request();
  r.mask = Image(kSize, kSize / 2, 1);
  EXPECT_THAT(refusal(r, ErrorCode::usage), HasSubstr("view's own size"));
  r.mask = Image(kSize, kSize, 1);
  EXPECT_THAT(refusal(r, ErrorCode::failed), HasSubstr("nothing of the object"));
}

TEST_F(PartTest, NothingAndEverythingAreNoParts) {
  PartRequest r = clicked();
  for (const float score : {0.0f, 1.0f}) {
    r.network = [&](const Scene& s, const PartRequest&, Progress&) {
      return std::vector<float>(s.handlers->positions.size(), score);
    };
    EXPECT_THAT(refusal(r, ErrorCode::failed), HasSubstr(score > 0 ? "whole object" : "Nothing is left"));
  }
}

}  // namespace
}  // namespace cei3d
