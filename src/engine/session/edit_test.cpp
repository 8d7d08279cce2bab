// SPDX-License-Identifier: Apache-2.0
// Edits by commands, on a project that holds a sphere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <functional>
#include <thread>

#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "core/math/rng.h"
#include "engine/io/image_file.h"
#include "engine/project/project.h"
#include "engine/render/render_cache.h"
#include "engine/render/sphere_scene.h"
#include "engine/session/session.h"
#include "model/material/presets.h"
#include "model/scene/appearance.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kSize = 48;

Capture three_views() {
  Capture c;
  c.root = "/nowhere";
  c.format = "nerf-synthetic";
  for (const Vec3d center : {Vec3d{0, -3, 0.3}, Vec3d{2, 2, 1}, Vec3d{-2, 1, -1}}) {
    View v;
    v.name = "train/r_" + std::to_string(c.views.size());
    v.camera = camera_towards_origin(center, kSize);
    c.views.push_back(v);
  }
  return c;
}

// Opaque in a square about the middle.
Image square_scribble(Vec3f srgb, int half) {
  Image s(kSize, kSize, 4);
  for (int y = kSize / 2 - half; y < kSize / 2 + half; ++y)
    for (int x = kSize / 2 - half; x < kSize / 2 + half; ++x) {
      for (int c = 0; c < 3; ++c) s.at(x, y)[c] = srgb[c];
      s.at(x, y)[3] = 1;
    }
  return s;
}

Region ball(Vec3f center, float radius) { return Region({{center}, {normalize(center)}, {radius}}); }

// What an edit leaves: the scene but for the names of its layers.
std::string bytes_of(const Scene& scene) {
  std::string bytes;
  const auto add = [&](const Tensors& t, const Json& h) { bytes += tensors_to_bytes(t) + h.dump(); };
  Tensors base;
  Json head = Json::object();
  save_scene(scene, base, head);
  add(base, head);
  for (EditLayer layer : scene.layers) {
    layer.id = "";
    Tensors t;
    Json h = Json::object();
    save_layer(layer, t, h);
    add(t, h);
  }
  return bytes;
}

std::string files_of(const fs::path& folder) {
  std::string list = read_file(folder / "stack.json");
  std::vector<std::string> files;
  for (const auto& e : fs::recursive_directory_iterator(folder)) files.push_back(e.path().string());
  std::sort(files.begin(), files.end());
  for (const std::string& f : files) list += f + "\n";
  return list;
}

class EditTest : public ::testing::Test {
 protected:
  void SetUp() override { make("a"); }
  fs::path folder(const std::string& name) const { return temp_.path() / name; }
  void make(const std::string& name) {
    Project::create(folder(name), {}, three_views(), false).save_base(sphere_with_handlers());
    session_.open(folder(name), Session::Access::write);
  }
  Scene scene(const std::string& name) { return Project::open(folder(name), Project::Mode::read).scene(); }
  // As `edit part` will do it.
  void add_part(const std::string& name, Vec3f center, float radius) {
    session_.close();
    {
      Project p = Project::open(folder("a"), Project::Mode::write);
      EditLayer layer;
      layer.id = p.stack().next_id("part");
      layer.region = ball(center, radius);
      layer.part = name;
      p.add_edit({layer.id, "part", 1, Json::object(), {}, Json::object(), {}}, layer);
    }
    session_.open(folder("a"), Session::Access::write);
  }
  PaintCommand scribble(int view, Vec3f srgb, int half) {
    const fs::path file = temp_.path() / "scribble.png";
    write_png(file, square_scribble(srgb, half));
    return {{{"train/r_" + std::to_string(view), file}}};
  }

  TempFolder temp_;
  Session session_;
  Progress quiet_;
};

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
  add_part("cap", {0, -kSphereRadius, 0}, 0.4f);
  add_part("nothing", {0, 0, 3}, 0.1f);
  const std::string before = files_of(folder("a"));
  const auto message = [&](MaterialCommand c) {
    return error_of([&] { session_.change_material(c, quiet_); });
  };
  MaterialCommand c;
  EXPECT_EQ(message(c).code(), ErrorCode::usage);
  for (const float r : {-0.1f, 1.1f, NAN, INFINITY}) {
    c.effects.roughness = r;
    EXPECT_EQ(message(c).code(), ErrorCode::usage) << r;
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
  c.part = "ear";
  EXPECT_EQ(message(c).code(), ErrorCode::usage);
  EXPECT_THAT(message(c).what(), HasSubstr("'cap', 'nothing'"));
  c.part = "nothing";
  EXPECT_THAT(message(c).what(), HasSubstr("nowhere on the surface"));
  c.part = "cap";
  for (const char* color : {"red", "#12345", "#12345g", "123456#", "#1234567"}) {
    c.effects.color = color;
    EXPECT_THAT(message(c).what(), HasSubstr("is not a color"));
  }
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

TEST_F(EditTest, WrongLightsChangeNothing) {
  const std::string before = files_of(folder("a"));
  const auto code = [&](const LightChoice& c) {
    return error_of([&] { session_.change_light(c, quiet_); }).code();
  };
  EXPECT_EQ(code({}), ErrorCode::usage);
  EXPECT_EQ(code({"", 0, EnvConvention::by_up_axis, 0}), ErrorCode::usage);
  EXPECT_EQ(code({"", NAN, EnvConvention::by_up_axis, 1}), ErrorCode::usage);
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
struct Made {
  int kind;
  std::string id;
  bool on = true;
};

class RandomEdits : public EditTest {
 protected:
  std::string make_edit(int kind) { return make_edit(session_, kind); }
  std::string make_edit(Session& session, int kind) {
    Progress quiet;
    MaterialCommand m;
    switch (kind) {
      case 0:
        return session.paint(scribble(0, {0.8f, 0.1f, 0.1f}, 6), quiet).id;
      case 8: {
        PaintCommand c = scribble(1, {0.1f, 0.7f, 0.2f}, 6);
        c.target = PaintTarget::radiance;
        c.routing = Routing::points;
        return session.paint(c, quiet).id;
      }
      case 1:
        m.effects.color = "#4060c0";
        return session.change_material(m, quiet).id;
      case 2:
        m.effects.roughness = 0.7f;
        m.effects.color = "#808080";
        return session.change_material(m, quiet).id;
      case 3:
        return session.change_light({"", 30, EnvConvention::by_up_axis, 1}, quiet).id;
      case 4:
        return session.change_light({"", 0, EnvConvention::by_up_axis, 1.5}, quiet).id;
      case 11: {
        PaintCommand c = scribble(0, {0.1f, 0.7f, 0.2f}, 5);
        c.material.preset = "copper";
        return session.paint(c, quiet).id;
      }
      case 9:
        m.effects.preset = "brass";
        m.effects.blend = 0.3;
        return session.change_material(m, quiet).id;
      case 10:
        m.effects.roughness_scale = 1.5;
        return session.change_material(m, quiet).id;
      case 5:
        m.effects.specular = 0.2f;
        return session.change_material(m, quiet).id;
      case 6:  // paint and this overlap
        return session.deform({PointDrag{{0.1, -0.69, 0.1}, {0.15, -0.8, 0.1}}, 0.35, ""}, quiet).id;
      default:
        return session.deform({PointDrag{{kSphereRadius, 0, 0}, {0.85, 0, 0.1}}, 0.35, ""}, quiet).id;
    }
  }
};

// What the session keeps in memory from command to command changes no bit of object and frame.
TEST_F(RandomEdits, AreShownWithTheBitsOfASessionThatJustOpened) {
  const Camera camera = camera_towards_origin({0, -3, 0.3}, kSize);
  std::vector<std::string> ids;
  std::vector<int> kinds;
  size_t cursor = 0;
  for (uint64_t step = 0; step < 12; ++step) {
    Rng rng(3, 8, step);
    const uint32_t what = rng.below(10);
    if (what < 6 || cursor == 0) {
      ids.resize(cursor);
      kinds.resize(cursor);
      int kind = int(rng.below(12));
      if (std::find(kinds.begin(), kinds.end(), kind) != kinds.end()) kind = kind == 8 ? 8 : kind % 6;
      kinds.push_back(kind);
      ids.push_back(make_edit(kind));
      ++cursor;
    } else if (what < 7) {
      session_.undo(quiet_);
      --cursor;
    } else if (what < 8 && cursor < ids.size()) {
      session_.redo(quiet_);
      ++cursor;
    } else {
      session_.toggle(ids[rng.below(uint32_t(ids.size()))], quiet_);
    }
    const Scene kept = session_.scene(), fresh = scene("a");
    ASSERT_EQ(bytes_of(kept), bytes_of(fresh)) << step;
    RenderCache& frames = session_.frames();
    const Frame frame = frames.shade(kept, frames.light(kept), *frames.trace(kept, camera, 1));
    const Frame plain = shade_view(session_.device(), fresh, trace_view(session_.device(), fresh, camera, 1));
    ASSERT_EQ(std::memcmp(frame.rgb.data.data(), plain.rgb.data.data(), 4 * frame.rgb.data.size()), 0)
        << step;
  }
  EXPECT_GT(session_.frames().hits_kept(), 0u);
  EXPECT_GT(session_.frames().view_count().found, 2u);
  EXPECT_GT(session_.frames().light_count().found, 2u);
}

TEST_F(RandomEdits, EndInTheSameBytesAsDoingWhatIsLeft) {
  for (uint64_t seed = 0; seed < 3; ++seed) {
    const std::string name = "random" + std::to_string(seed), direct = "direct" + std::to_string(seed);
    make(name);
    std::vector<Made> history;
    size_t cursor = 0;
    for (uint64_t step = 0; step < 16; ++step) {
      Rng rng(seed, 7, step);
      const uint32_t what = rng.below(10);
      if (what < 5 || history.empty()) {
        int kind = int(rng.below(12));
        history.resize(cursor);
        if (std::any_of(history.begin(), history.end(), [&](const Made& m) { return m.kind == kind; }))
          kind = kind == 8 ? 8 : kind % 6;
        history.push_back({kind, make_edit(kind)});
        ++cursor;
      } else if (what < 7 && cursor > 0) {
        EXPECT_EQ(session_.undo(quiet_), history[--cursor].id);
      } else if (what < 8 && cursor < history.size()) {
        EXPECT_EQ(session_.redo(quiet_), history[cursor++].id);
      } else {
        Made& e = history[rng.below(uint32_t(history.size()))];
        EXPECT_EQ(session_.toggle(e.id, quiet_), !e.on);
        e.on = !e.on;
      }
    }
    make(direct);
    for (size_t i = 0; i < cursor; ++i)
      if (history[i].on) make_edit(history[i].kind);
    EXPECT_EQ(bytes_of(scene(name)), bytes_of(scene(direct))) << seed;
  }
}

TEST_F(RandomEdits, ReplayedOnAnotherProjectGiveTheSameObject) {
  for (const int kind : {0, 1, 3, 2, 4}) make_edit(kind);
  session_.toggle("0002-material", quiet_);
  session_.undo(quiet_);
  make("b");
  session_.open(folder("a"), Session::Access::read);
  const ReplayReport r = session_.replay(folder("b"), quiet_);
  ASSERT_EQ(r.edits.size(), 4u);
  EXPECT_EQ(bytes_of(scene("a")), bytes_of(scene("b")));
  const Project b = Project::open(folder("b"), Project::Mode::read);
  EXPECT_EQ(b.stack().entries().size(), 4u);
  EXPECT_FALSE(b.stack().entries()[1].enabled);
  EXPECT_EQ(error_of([&] { session_.replay(folder("a"), quiet_); }).code(), ErrorCode::usage);
}

TEST_F(RandomEdits, AreTheSameBitsOnAnyNumberOfThreads) {
  for (const int kind : {0, 6, 1, 3}) make_edit(kind);
  const std::string all_threads = bytes_of(scene("a"));
  session_.close();
  Project::create(folder("b"), {}, three_views(), false).save_base(sphere_with_handlers());
  Session one("auto", 1);
  one.open(folder("b"), Session::Access::write);
  for (const int kind : {0, 6, 1, 3}) make_edit(one, kind);
  EXPECT_EQ(bytes_of(one.scene()), all_threads);
}

// Each with its own project, threads and progress.
TEST_F(RandomEdits, OfTwoSessionsInTwoThreadsAreThoseOfOneAfterTheOther) {
  const auto edited = [&](Session& session, const std::string& name) {
    Project::create(folder(name), {}, three_views(), false).save_base(sphere_with_handlers());
    session.open(folder(name), Session::Access::write);
    for (const int kind : {0, 6, 1}) make_edit(session, kind);
    RenderCache& frames = session.frames();
    const Scene scene = session.scene();
    const auto view = frames.trace(scene, camera_towards_origin({0, -3, 0.3}, kSize), 1);
    return std::pair(bytes_of(scene), frames.shade(scene, frames.light(scene), *view).rgb.data);
  };
  scribble(0, {0.8f, 0.1f, 0.1f}, 6);  // writes the picture that both read
  Session alone("auto", 2), first("auto", 2), second("auto", 1);
  const auto expected = edited(alone, "alone");
  std::pair<std::string, std::vector<float>> a, b;
  std::thread other([&] { b = edited(second, "two"); });
  a = edited(first, "one");
  other.join();
  EXPECT_EQ(a, expected);
  EXPECT_EQ(b, expected);
}

TEST_F(RandomEdits, AWholeMaterialIsExported) {
  make_edit(2);  // roughness 0.7
  const fs::path file = temp_.path() / "object.glb";
  session_.export_to({file}, quiet_);
  const std::string glb = read_file(file);
  EXPECT_THAT(glb.substr(0, glb.find("BIN")), HasSubstr("\"roughnessFactor\":0.69999"));
}

TEST_F(RandomEdits, WhatCannotBeMadeAnewKeepsTheHistoryAsItIs) {
  add_part("cap", {0, -kSphereRadius, 0}, 0.4f);
  MaterialCommand c{"cap", {}};
  c.effects.roughness = 0.9f;
  session_.change_material(c, quiet_);
  const std::string before = files_of(folder("a"));
  const Error e = error_of([&] { session_.toggle("0001-part", quiet_); });
  EXPECT_THAT(e.what(), HasSubstr("0002-material"));
  EXPECT_THAT(e.what(), HasSubstr("There is no part 'cap'"));
  EXPECT_EQ(files_of(folder("a")), before);
  session_.toggle("0002-material", quiet_);
  EXPECT_FALSE(session_.toggle("0001-part", quiet_));
}

class StoredEdits : public RandomEdits {
 protected:
  // A drag, and on top of it paint that has to be made anew when the drag goes; then changes what is stored
  // of the paint.
  void make_and_change(const std::function<void(Json& edit)>& change) {
    make_edit(6);
    make_edit(0);
    session_.close();
    const fs::path file = folder("a") / "edits" / kPaint / "edit.json";
    Json edit = Json::parse(read_file(file));
    change(edit);
    write_file_atomic(file, edit.dump(1));
    session_.open(folder("a"), Session::Access::write);
  }
  Json stored() const { return Json::parse(read_file(folder("a") / "edits" / kPaint / "edit.json")); }
  void expect_refused(const std::string& why) {
    const std::string before = files_of(folder("a"));
    EXPECT_THAT(error_of([&] { session_.toggle("0001-deform", quiet_); }).what(), HasSubstr(why));
    EXPECT_EQ(files_of(folder("a")), before);
    make("b");
    session_.open(folder("a"), Session::Access::read);
    EXPECT_THAT(error_of([&] { session_.replay(folder("b"), quiet_); }).what(), HasSubstr(why));
  }
  static constexpr const char* kPaint = "0002-paint";
};

TEST_F(StoredEdits, OfANewerOperationAreNotMadeAnew) {
  make_and_change([](Json& edit) { edit["op_version"] = 99; });
  expect_refused("version 99 of 'paint'");
}

TEST_F(StoredEdits, WithUnknownParametersAreNotMadeAnew) {
  make_and_change([](Json& edit) { edit["params"]["sead"] = 3; });
  expect_refused("unknown key 'sead'; the nearest known key is 'seed'");
}

TEST_F(StoredEdits, WithUnknownKeysAreNotRead) {
  make_and_change([](Json& edit) { edit["reports"] = 3; });
  EXPECT_THAT(error_of([&] { session_.log(); }).what(), HasSubstr("nearest known key is 'report'"));
}

TEST_F(StoredEdits, OfAnOlderOperationAreMigratedAndNoted) {
  make_and_change([](Json& edit) {  // as the first version stored it: one stroke, its keys among the others
    Json& params = edit["params"];
    edit["op_version"] = 1;
    params["file"] = params["strokes"][0]["file"];
    params.erase("strokes");
  });
  make("b");
  session_.open(folder("a"), Session::Access::write);
  const ReplayReport r = session_.replay(folder("b"), quiet_);
  ASSERT_EQ(r.notes.size(), 1u);
  EXPECT_THAT(r.notes[0], HasSubstr("0002-paint was made by version 1 of 'paint'"));
  EXPECT_EQ(bytes_of(scene("a")), bytes_of(scene("b")));
  EXPECT_FALSE(stored()["report"].contains("note"));
  session_.toggle("0001-deform", quiet_);
  EXPECT_THAT(stored()["report"]["note"].get<std::string>(), HasSubstr("first made by version 1"));
  make("c");
  make_edit(0);
  EXPECT_EQ(bytes_of(scene("a")), bytes_of(scene("c")));
}

}  // namespace
}  // namespace cei3d
