// SPDX-License-Identifier: Apache-2.0
// Edits by commands, on a project that holds a sphere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>

#include "core/base/error_of.h"
#include "engine/render/render.h"
#include "engine/session/test_edits.h"
#include "model/material/presets.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST_F(EditTest, MaterialOfTheWholeObject) {
  MaterialCommand c;
  c.effects.roughness = 0.6f;
  c.effects.color = "#bcbcbc";  // linear 0.503
  const EditSummary s = session_.change_material(c, quiet_);
  EXPECT_EQ(s.id, "0001-material");
  const Scene after = scene("a");
  const auto hits = vertex_hits(after.surface->mesh());
  const Appearance a = appearance_at(session_.device(), after, hits);
  Vec3f mean{0, 0, 0};
  for (size_t i = 0; i < hits.size(); ++i) {
    EXPECT_EQ(a.material[i].roughness, 0.6f);
    EXPECT_EQ(a.layer[i], -1);         // everywhere is not local
    const Vec3f p = hits[i].position;  // rows of a sphere's mesh: by area
    mean += a.albedo[i] * std::sqrt(max(0.0f, 1 - square(p.z / kSphereRadius)));
  }
  for (int c2 = 0; c2 < 3; ++c2) EXPECT_NEAR(mean[c2] / mean[0], 1, 0.02f);
  EXPECT_NEAR(after.layers[0].tint->color.x, 0.5029f, 1e-3f);
}

TEST_F(EditTest, MaterialOfAPartStaysInThePart) {
  add_part("cap", {0, -kSphereRadius, 0}, 0.4f);
  const Scene before = scene("a");
  MaterialCommand c{"cap", {}};
  c.effects.roughness = 0.9f;
  c.effects.metalness = 1;
  c.effects.color = "#ff0000";
  c.effects.replace = true;
  session_.change_material(c, quiet_);
  const Scene after = scene("a");
  const Device& device = session_.device();
  const GBuffer g = trace_view(device, before, camera_towards_origin({0, -3, 0.3}, kSize), 2);
  const Frame a = shade_view(device, before, g), b = shade_view(device, after, g);
  int inside = 0, changed = 0;
  for (size_t p = 0; p < b.edited.size(); ++p) {
    inside += b.edited[p];
    const bool same = std::memcmp(&a.rgb.data[4 * p], &b.rgb.data[4 * p], 16) == 0;
    changed += !same;
    EXPECT_TRUE(same || b.edited[p]);
    EXPECT_TRUE(b.edited[p] || a.roughness.data[p] == b.roughness.data[p]);
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(changed, inside * 9 / 10);
  const size_t middle = size_t(kSize) * kSize / 2 + kSize / 2;
  EXPECT_NEAR(b.roughness.data[middle], 0.9f, 1e-6f);
  EXPECT_EQ(b.albedo.data[4 * middle], 1);
  EXPECT_EQ(b.diffuse.data[4 * middle], 0);  // a metal
}

TEST_F(EditTest, MaterialsAreScaledAndBlendedOnTopOfEachOther) {
  add_part("cap", {0, -kSphereRadius, 0}, 0.4f);
  const Scene before = scene("a");
  const Material base = before.material.mean();
  const std::vector<Hit> hits = vertex_hits(before.surface->mesh());
  const Appearance was = appearance_at(session_.device(), before, hits);
  MaterialCommand scale, blend{"cap", {}};
  scale.effects.roughness_scale = 0.5;
  blend.effects.preset = "gold";
  blend.effects.blend = 0.25;
  session_.change_material(scale, quiet_);
  session_.change_material(blend, quiet_);
  const Appearance is = appearance_at(session_.device(), scene("a"), hits);
  const MaterialPreset& gold = *find_material_preset("gold");
  size_t inside = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    const bool in = was.layer[i] == 0;
    inside += in;
    const float half = 0.5f * base.roughness;
    EXPECT_FLOAT_EQ(is.material[i].roughness, in ? 0.75f * half + 0.25f * gold.material.roughness : half);
    EXPECT_EQ(is.material[i].metalness, in ? 0.25f : 0);
    for (int c = 0; c < 3; ++c) {
      if (in) {
        EXPECT_FLOAT_EQ(is.albedo[i][c], 0.75f * was.albedo[i][c] + 0.25f * gold.color[c]);
      } else {
        EXPECT_EQ(is.albedo[i][c], was.albedo[i][c]);
      }
    }
  }
  EXPECT_GT(inside, 100u);
  // Without the first, the second blends with what the object has by itself.
  session_.toggle("0002-material", quiet_);
  const Appearance left = appearance_at(session_.device(), scene("a"), hits);
  for (size_t i = 0; i < hits.size(); ++i)
    if (was.layer[i] != 0) {
      EXPECT_EQ(left.material[i], base);
    }
}

TEST_F(EditTest, APresetSetsWhatTheCommandDoesNot) {
  const auto edited = [&](const MaterialEffects& effects) {
    session_.change_material({"", effects}, quiet_);
    const EditLayer layer = scene("a").layers.back();
    session_.undo(quiet_);
    return layer;
  };
  const MaterialPreset& copper = *find_material_preset("copper");
  MaterialEffects e;
  e.preset = "copper";
  EditLayer layer = edited(e);
  EXPECT_EQ(changed({}, layer.material), copper.material);
  EXPECT_EQ(layer.tint->color.y, copper.color.y);
  EXPECT_FALSE(layer.tint->keep_texture);
  e.roughness = 0.75;
  e.color = "#808080";
  layer = edited(e);
  EXPECT_EQ(layer.material.roughness, 0.75f);
  EXPECT_EQ(layer.material.metalness, 1.0f);
  EXPECT_TRUE(layer.tint->keep_texture);
  e.roughness.reset();
  e.roughness_scale = 2;
  layer = edited(e);
  EXPECT_EQ(layer.material.roughness, std::nullopt);
  EXPECT_EQ(layer.material.roughness_scale, 2.0f);
}

TEST_F(EditTest, AnEraserTakesGoldLeafOffAgain) {
  PaintCommand gold = scribble(0, {0.8f, 0.1f, 0.1f}, 6);
  gold.material.preset = "gold";
  session_.paint(gold, quiet_);
  PaintCommand eraser = scribble(0, {0, 0, 0}, 10);
  eraser.erase = true;
  session_.paint(eraser, quiet_);
  const Scene after = scene("a");
  Scene before = after;
  before.layers.clear();
  const std::vector<Hit> hits = vertex_hits(after.surface->mesh());
  const Appearance was = appearance_at(session_.device(), before, hits),
                   is = appearance_at(session_.device(), after, hits);
  for (size_t i = 0; i < hits.size(); ++i) {
    EXPECT_EQ(is.material[i], was.material[i]);
    EXPECT_EQ(std::memcmp(&is.albedo[i], &was.albedo[i], sizeof(Vec3f)), 0);
  }
}

TEST_F(EditTest, GoldLeafIsPaintedAndUndone) {
  const Scene before = scene("a");
  PaintCommand c = scribble(0, {0.8f, 0.1f, 0.1f}, 8);
  c.material.preset = "gold";
  c.material.roughness = 0.5;
  session_.paint(c, quiet_);
  const LogEntry entry = session_.log().back();
  EXPECT_EQ(entry.params.at("material"), "gold");
  EXPECT_EQ(entry.params.at("roughness"), 0.5);
  const std::vector<Hit> hits = vertex_hits(before.surface->mesh());
  const Appearance was = appearance_at(session_.device(), before, hits),
                   is = appearance_at(session_.device(), scene("a"), hits);
  const Vec3f gold = find_material_preset("gold")->color;
  size_t inside = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    const bool in = is.layer[i] == 0;
    inside += in;
    EXPECT_EQ(is.material[i].metalness, in ? 1 : 0);
    EXPECT_EQ(is.material[i].roughness, in ? 0.5f : was.material[i].roughness);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(is.albedo[i][k], in ? gold[k] : was.albedo[i][k]);
  }
  EXPECT_GT(inside, 100u);
  session_.undo(quiet_);
  EXPECT_EQ(bytes_of(scene("a")), bytes_of(before));
}

TEST_F(EditTest, PaintRefusesAMaterialThatMakesNoSense) {
  const std::string before = files_of(folder("a"));
  const auto code = [&](const std::function<void(PaintCommand&)>& set) {
    PaintCommand c = scribble(0, {0.8f, 0.1f, 0.1f}, 6);
    c.material.preset = "gold";
    set(c);
    return error_of([&] { session_.paint(c, quiet_); }).code();
  };
  EXPECT_EQ(code([](PaintCommand& c) { c.erase = true; }), ErrorCode::usage);
  EXPECT_EQ(code([](PaintCommand& c) { c.routing = Routing::none; }), ErrorCode::usage);
  EXPECT_EQ(code([](PaintCommand& c) { c.target = PaintTarget::radiance; }), ErrorCode::usage);
  EXPECT_EQ(code([](PaintCommand& c) { c.target = PaintTarget::appearance; }), ErrorCode::usage);
  EXPECT_EQ(code([](PaintCommand& c) { c.material.preset = "gild"; }), ErrorCode::usage);
  EXPECT_EQ(code([](PaintCommand& c) { c.material.blend = 0.5; }), ErrorCode::usage);
  EXPECT_EQ(code([](PaintCommand& c) { c.material.color = "#ffffff"; }), ErrorCode::usage);
  EXPECT_EQ(files_of(folder("a")), before);
}

TEST_F(EditTest, WrongMaterialsChangeNothing) {
  const std::string before = files_of(folder("a"));
  const auto message = [&](MaterialCommand c) {
    return error_of([&] { session_.change_material(c, quiet_); });
  };
  MaterialCommand c;
  EXPECT_EQ(message(c).code(), ErrorCode::usage);
  for (const float r : {-0.1f, 1.1f, NAN, INFINITY}) {
    c.effects.roughness = r;
    EXPECT_EQ(message(c).code(), ErrorCode::usage) << r;
    EXPECT_THAT(message(c).what(), StartsWith("The roughness ")) << r;  // the editor says it, too
  }
  c.effects.roughness = 0.5f;
  c.effects.roughness_scale = 2;
  EXPECT_THAT(message(c).what(), HasSubstr("not both"));
  c.effects.roughness.reset();
  for (const float s : {-0.1f, NAN, INFINITY}) {
    c.effects.roughness_scale = s;
    EXPECT_EQ(message(c).code(), ErrorCode::usage) << s;
  }
  c.effects = {};
  c.effects.blend = 0.5;
  EXPECT_THAT(message(c).what(), HasSubstr("Nothing to change"));
  c.effects.roughness = 0.5f;
  for (const float b : {-0.1f, 1.1f, NAN}) {
    c.effects.blend = b;
    EXPECT_EQ(message(c).code(), ErrorCode::usage) << b;
  }
  c.effects.blend.reset();
  c.effects.preset = "sliver";
  EXPECT_THAT(message(c).what(), HasSubstr("near names are: silver"));
  c.effects.preset = "";
  for (const char* color : {"red", "#12345", "#12345g", "123456#", "#1234567"}) {
    c.effects.color = color;
    EXPECT_THAT(message(c).what(), HasSubstr("is not a color"));
  }
  EXPECT_EQ(files_of(folder("a")), before);
}

TEST_F(EditTest, MaterialsOfWrongPartsChangeNothing) {
  add_part("cap", {0, -kSphereRadius, 0}, 0.4f);
  add_part("nothing", {0, 0, 3}, 0.1f);
  const std::string before = files_of(folder("a"));
  const auto message = [&](MaterialCommand c) {
    return error_of([&] { session_.change_material(c, quiet_); });
  };
  MaterialCommand c;
  c.effects.roughness = 0.5f;
  c.part = "ear";
  EXPECT_EQ(message(c).code(), ErrorCode::usage);
  EXPECT_THAT(message(c).what(), HasSubstr("'cap', 'nothing'"));
  c.part = "nothing";
  EXPECT_THAT(message(c).what(), HasSubstr("nowhere on the surface"));
  EXPECT_EQ(files_of(folder("a")), before);
}

TEST_F(EditTest, LightIsTurnedScaledAndReplaced) {
  const SgMixture own = sphere_scene().light;
  session_.change_light({"", 90, EnvConvention::by_up_axis, 1}, quiet_);
  session_.change_light({"", 0, EnvConvention::by_up_axis, 2}, quiet_);
  const SgMixture turned = scene("a").light;
  EXPECT_NEAR(turned.lobes[1].axis.y, 1, 1e-6f);  // +X, a quarter about +Z
  EXPECT_EQ(turned.lobes[1].mu.x, 2 * own.lobes[1].mu.x);
  // Without the first, the second works on the object's own light.
  EXPECT_FALSE(session_.toggle("0001-light", quiet_));
  EXPECT_EQ(scene("a").light.lobes[1].axis.x, 1);
  EXPECT_EQ(scene("a").light.lobes[1].mu.x, 2 * own.lobes[1].mu.x);
  EXPECT_TRUE(session_.toggle("0001-light", quiet_));
  EXPECT_EQ(to_array(scene("a").light), to_array(turned));
  const fs::path sky = temp_.path() / "sky.hdr";
  Image gray(16, 8, 3, 0.5f);
  write_hdr(sky, gray);
  const EditSummary s = session_.change_light({sky, 0, EnvConvention::by_up_axis, 1}, quiet_);
  EXPECT_NEAR(radiance(scene("a").light, {0, 0.6f, 0.8f}).y, 0.5f, 0.1f);
  EXPECT_EQ(scene("a").light.lobes.size(), s.report.at("lobes").get<size_t>());
  fs::remove(sky);  // it is not needed again
  session_.toggle("0001-light", quiet_);
  EXPECT_NEAR(radiance(scene("a").light, {0, 0.6f, 0.8f}).y, 0.5f, 0.1f);
}

TEST_F(EditTest, ASunGivesWhatItsStrengthSays) {
  const SgMixture own = scene("a").light;
  session_.change_light({"", 0, EnvConvention::by_up_axis, 1, Sun{{0, 3, 4}, 2}}, quiet_);
  const SgMixture all = scene("a").light;
  ASSERT_EQ(all.lobes.size(), own.lobes.size() + 1);
  const SgMixture sun{{all.lobes.back()}};
  // Irradiance by summing over directions: around the sun, and of the rest over all normals.
  const auto around = [&](int i, int n, float widest) {  // equal shares of a cap about the sun
    const float c = 1 - widest * (float(i) + 0.5f) / float(n), s = std::sqrt(1 - c * c), t = 2.4f * float(i);
    const Vec3f z{0, 0.6f, 0.8f}, x{1, 0, 0}, y = cross(z, x);
    return z * c + x * (s * std::cos(t)) + y * (s * std::sin(t));
  };
  constexpr int kRays = 200000;
  double facing = 0, mean = 0;
  for (int i = 0; i < kRays; ++i) {
    const Vec3f near = around(i, kRays, 0.02f);
    facing += radiance(sun, near).y * dot(near, Vec3f{0, 0.6f, 0.8f}) * 2 * kPi * 0.02 / kRays;
    const Vec3f l = radiance(own, around(i, kRays, 2));
    mean += (l.x + l.y + l.z) / 3 * 4 * kPi / kRays / 4;
  }
  EXPECT_NEAR(facing / mean, 2, 0.01);
}

TEST_F(EditTest, WrongLightsChangeNothing) {
  const std::string before = files_of(folder("a"));
  const auto code = [&](const LightChoice& c) {
    return error_of([&] { session_.change_light(c, quiet_); }).code();
  };
  EXPECT_EQ(code({}), ErrorCode::usage);
  EXPECT_EQ(code({"", 0, EnvConvention::by_up_axis, 0}), ErrorCode::usage);
  EXPECT_EQ(code({"", NAN, EnvConvention::by_up_axis, 1}), ErrorCode::usage);
  EXPECT_EQ(code({"", 0, EnvConvention::by_up_axis, 1, Sun{{0, 0, 0}, 1}}), ErrorCode::usage);
  EXPECT_EQ(code({"", 0, EnvConvention::by_up_axis, 1, Sun{{0, 0, 1}, -1}}), ErrorCode::usage);
  const fs::path sky = temp_.path() / "sky.hdr";
  write_hdr(sky, Image(16, 16, 3, 0.5f));
  EXPECT_EQ(code({sky, 0, EnvConvention::by_up_axis, 1}), ErrorCode::failed);
  write_hdr(sky, Image(16, 8, 3, 0));
  EXPECT_EQ(code({sky, 0, EnvConvention::by_up_axis, 1}), ErrorCode::failed);
  EXPECT_EQ(files_of(folder("a")), before);
}

TEST_F(EditTest, AnEditShowsWhatItChanged) {
  const std::string paint = session_.paint(scribble(0, {0.8f, 0.1f, 0.1f}, 6), quiet_).id;
  const std::string deform =
      session_.deform({PointDrag{{kSphereRadius, 0, 0}, {0.85, 0, 0.1}}, 0.35, ""}, quiet_).id;
  const std::string light = session_.change_light({"", 30, EnvConvention::by_up_axis, 1}, quiet_).id;
  const fs::path picture = temp_.path() / "change.png";
  const ChangeSummary p = session_.show_change({paint, "", picture, 2});
  EXPECT_EQ(p.view, "train/r_0");
  // Twelve pixels each way, and the neighbors whose colors they are part of.
  EXPECT_GE(p.pixels_inside, 12u * 12u);
  EXPECT_LE(p.pixels_inside, 14u * 14u);
  EXPECT_GT(p.pixels_changed, 12u * 12u * 9u / 10u);
  EXPECT_EQ(p.changed_outside, 0u);
  const Image image = read_image(picture);
  EXPECT_EQ(image.width, 2 * kSize);
  EXPECT_EQ(image.height, kSize);
  EXPECT_GT(image.at(kSize + kSize / 2, kSize / 2)[0], image.at(kSize / 2, kSize / 2)[0]);  // red afterwards
  const ChangeSummary d = session_.show_change({deform, "train/r_1", "", 2});
  EXPECT_GT(d.pixels_changed, 50u);
  EXPECT_EQ(d.changed_outside, 0u);
  const ChangeSummary l = session_.show_change({light, "", "", 2});
  EXPECT_GT(l.pixels_inside, 500u);
  EXPECT_EQ(l.changed_outside, 0u);
  EXPECT_EQ(error_of([&] { session_.show_change({"0009-paint", "", "", 2}); }).code(), ErrorCode::usage);
}

// A project that is edited, undone, redone and switched at random ends as one where the edits that are left
// were simply made.
}  // namespace
}  // namespace cei3d
