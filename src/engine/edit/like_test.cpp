// SPDX-License-Identifier: Apache-2.0
// Parts by their material, on a sphere that is metal on one side.
#include "engine/edit/like.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/error_of.h"
#include "engine/render/sphere_scene.h"
#include "model/scene/appearance.h"
#include "model/scene/parts.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;

constexpr int kSize = 96;
constexpr float kMargin = 0.06f;  // of what is not looked at on both sides of a border

// Metal where x > 0; the roughness is one half everywhere.
MaterialField half_metal() {
  FieldConfig c;
  c.hidden_layers = 0;
  c.outputs = MaterialField::kOutputs;
  c.output_activation = Activation::sigmoid;
  auto field = std::make_shared<Field>(c, 1);
  for (Param& p : field->params().all()) std::fill(p.value.begin(), p.value.end(), 0.0f);
  field->params().get("layer0/weight").value[3] = 60;  // x to the metalness
  return {Material{0.5f, 0.5f, 0.5f}, field};
}

EditLayer ball(Vec3f center, float radius) {
  EditLayer l;
  l.id = "0001-material";
  l.region = Region({{center}, {normalize(center)}, {radius}, {}});
  return l;
}

class LikeTest : public ::testing::Test {
 protected:
  PartRequest request(Vec3f direction, bool color = false) const {
    PartRequest r;
    r.id = "0002-part";
    r.name = "metal";
    r.view = "train/r_0";
    r.camera = camera_towards_origin({0, -3, 0.3}, kSize);
    const Vec3d p = r.camera.project(to_double(normalize(direction) * kSphereRadius));
    r.like = PartLikeness{{float(p.x), float(p.y)}, color};
    return r;
  }
  // Every vertex away from the border is in the part exactly if the depth there is positive.
  void expect_part(const PartRequest& r, const std::function<float(Vec3f)>& depth) {
    const Scene after = with_layer(scene_, select_part(device_, scene_, r, quiet_).layer);
    const std::vector<Hit> hits = vertex_hits(scene_.surface->mesh());
    const std::vector<uint8_t> inside = inside_layer(after, after.layers.back(), hits);
    int in = 0, out = 0;
    for (size_t i = 0; i < hits.size(); ++i) {
      const float d = depth(hits[i].position);
      if (std::abs(d) < kMargin) continue;
      EXPECT_EQ(inside[i], d > 0) << d;
      ++(d > 0 ? in : out);
    }
    EXPECT_GT(in, 50);
    EXPECT_GT(out, 50);
  }
  std::string refusal(const PartRequest& r) {
    return message([&] { select_part(device_, scene_, r, quiet_); });
  }

  const Device device_ = make_device();
  Scene scene_ = sphere_with_handlers();
  Progress quiet_;
};

TEST_F(LikeTest, AClickOnTheMetalSelectsAllMetalAndNothingElse) {
  scene_.material = half_metal();
  expect_part(request({0.5f, -0.8f, 0}), [](Vec3f p) { return p.x; });
  expect_part(request({-0.5f, -0.8f, 0.2f}), [](Vec3f p) { return -p.x; });
}

TEST_F(LikeTest, EffectsOfTheSameEditStayInIt) {
  scene_.material = half_metal();
  PartRequest r = request({0.5f, -0.8f, 0});
  r.change.roughness_scale = 0.5f;
  r.color = Vec3f{0.955f, 0.638f, 0.538f};
  const Scene after = with_layer(scene_, select_part(device_, scene_, r, quiet_).layer);
  const std::vector<Hit> hits = vertex_hits(scene_.surface->mesh());
  const Appearance was = appearance_at(device_, scene_, hits), is = appearance_at(device_, after, hits);
  for (size_t i = 0; i < hits.size(); ++i) {
    if (std::abs(hits[i].position.x) < kMargin) continue;
    const bool in = hits[i].position.x > 0;
    EXPECT_EQ(is.material[i].roughness, was.material[i].roughness * (in ? 0.5f : 1.0f));
    EXPECT_EQ(is.albedo[i].x, in ? 0.955f : was.albedo[i].x);
  }
}

TEST_F(LikeTest, WithColorBothCount) {
  scene_.material = half_metal();
  EditLayer gray = ball({0, 0, kSphereRadius}, 0.7f), red = gray;
  gray.everywhere = true;
  gray.tint = Tint{{0.4f, 0.4f, 0.4f}, false};
  red.tint = Tint{{0.5f, 0.1f, 0.1f}, false};
  scene_ = with_layer(with_layer(scene_, gray), red);
  const auto cap = [](Vec3f p) { return 0.7f - length(p - Vec3f{0, 0, kSphereRadius}); };
  expect_part(request({0.4f, -0.5f, 0.6f}, true), [&](Vec3f p) { return std::min(p.x, cap(p)); });
  expect_part(request({0.4f, -0.8f, -0.1f}, true), [&](Vec3f p) { return std::min(p.x, -cap(p)); });
  expect_part(request({0.4f, -0.5f, 0.6f}), [](Vec3f p) { return p.x; });
}

TEST_F(LikeTest, MaterialsThatEditsGaveAreFound) {
  EditLayer metal = ball({0, -kSphereRadius, 0}, 0.4f);
  metal.material.metalness = 1;
  scene_ = with_layer(scene_, metal);
  expect_part(request({0, -1, 0}), [](Vec3f p) { return 0.4f - length(p - Vec3f{0, -kSphereRadius, 0}); });
}

TEST_F(LikeTest, ErrorsSayWhatToDo) {
  EXPECT_THAT(refusal(request({0, -1, 0})), HasSubstr("The object has one material; go by the color"));
  PartRequest r = request({0, -1, 0});
  r.like->pixel = {1, 1};
  EXPECT_THAT(refusal(r), HasSubstr("background"));
  r.like->pixel = {1, float(kSize + 1)};
  EXPECT_THAT(refusal(r), HasSubstr("not in view"));
  EditLayer gray = ball({0, 0, 1}, 1);
  gray.everywhere = true;
  gray.tint = Tint{{0.4f, 0.4f, 0.4f}, false};
  scene_ = with_layer(scene_, gray);
  EXPECT_THAT(refusal(request({0, -1, 0}, true)), HasSubstr("one material and one color"));
}

}  // namespace
}  // namespace cei3d
