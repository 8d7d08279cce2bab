// SPDX-License-Identifier: Apache-2.0
// Random histories of edits, and edits that older or newer programs have stored.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <thread>

#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/math/rng.h"
#include "engine/render/render_cache.h"
#include "engine/session/test_edits.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

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
      case 8:
        return session.paint(unlit_paint(), quiet).id;
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
      case 11:
        return session.paint(copper_paint(), quiet).id;
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

 private:
  PaintCommand unlit_paint() {
    PaintCommand c = scribble(1, {0.1f, 0.7f, 0.2f}, 6);
    c.target = PaintTarget::radiance;
    c.routing = Routing::points;
    return c;
  }
  PaintCommand copper_paint() {
    PaintCommand c = scribble(0, {0.1f, 0.7f, 0.2f}, 5);
    c.material.preset = "copper";
    return c;
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
  ExportRequest request;
  request.out = {file};
  request.texture = 0;
  session_.export_to(request, quiet_);
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
