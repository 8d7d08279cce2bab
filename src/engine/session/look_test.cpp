// SPDX-License-Identifier: Apache-2.0
// What a live editor asks of a session: edits by free cameras, previews, frames in tiles, the history.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>

#include "core/base/error_of.h"
#include "core/base/json.h"
#include "engine/session/edit_plan.h"
#include "engine/session/frame_files.h"
#include "engine/session/test_edits.h"
#include "engine/session/tiled_frame.h"
#include "model/geometry/shape/camera_json.h"

namespace cei3d {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class LookTest : public EditTest {
 protected:
  Camera camera_of(int view) { return session_.views()[size_t(view)].camera; }
  MaterialCommand rough(double roughness) {
    MaterialCommand c;
    c.effects.roughness = roughness;
    return c;
  }
  std::vector<std::string> done() {
    std::vector<std::string> ids;
    for (const LogEntry& e : session_.log())
      if (e.done) ids.push_back(e.id);
    return ids;
  }
  // The 8-bit picture that the tiles make.
  std::vector<uint8_t> picture(TiledFrame& frame, int width, int height) {
    std::vector<uint8_t> out(4 * size_t(width) * size_t(height));
    while (const auto tile = frame.next())
      for (int y = 0; y < tile->box.height; ++y)
        std::copy_n(&tile->rgba[4 * size_t(y) * size_t(tile->box.width)], 4 * tile->box.width,
                    &out[4 * (size_t(tile->box.y0 + y) * size_t(width) + size_t(tile->box.x0))]);
    return out;
  }
};

// The camera of a view and the view itself are the same place.
TEST_F(LookTest, AFreeCameraPaintsAndSelectsWhatItsViewDoes) {
  const PaintCommand by_view = scribble(0, {0.8f, 0.1f, 0.1f}, 6);
  PartCommand part;
  part.view = "train/r_0";
  part.positive = {{24, 24}};
  part.in_view = true;
  session_.paint(by_view, quiet_);
  const std::string painted = bytes_of(session_.scene());
  session_.undo(quiet_);
  PaintCommand by_camera = by_view;
  by_camera.strokes[0].view = "";
  by_camera.strokes[0].camera = camera_of(0);
  by_camera.strokes[0].scribble.bytes = by_view.strokes[0].scribble.read();
  by_camera.strokes[0].scribble.path.clear();
  session_.paint(by_camera, quiet_);
  EXPECT_EQ(bytes_of(session_.scene()), painted);
  const Json stored = session_.log()[0].params;
  EXPECT_FALSE(stored.contains("view"));
  EXPECT_EQ(stored["strokes"][0]["camera"], camera_json(camera_of(0)));
  EXPECT_EQ(bytes_of(scene("a")), painted);
  EXPECT_GT(session_.show_change({session_.log()[0].id, "", {}}).pixels_changed, 100u);

  by_camera.strokes[0].view = "train/r_0";
  EXPECT_THAT(message([&] { session_.paint(by_camera, quiet_); }), HasSubstr("not both"));
  by_camera.strokes[0].view = "";
  by_camera.strokes[0].camera->world_from_cam.row[0].x = 2;
  EXPECT_THAT(message([&] { session_.paint(by_camera, quiet_); }), HasSubstr("rotation"));
}

TEST_F(LookTest, ADragByAFreeCameraIsThatOfItsView) {
  const Vec2<double> pixel{24, 24}, drag{3, 1};
  session_.deform({PixelDrag{"train/r_0", pixel, drag, {}}, 0.35, ""}, quiet_);
  const Json by_view = session_.log()[0].params;
  session_.undo(quiet_);
  session_.deform({PixelDrag{"", pixel, drag, camera_of(0)}, 0.35, ""}, quiet_);
  EXPECT_EQ(session_.log()[0].params, by_view);
}

TEST_F(LookTest, APreviewIsStoredAsTheEditItselfOrLeavesNothing) {
  session_.change_material(rough(0.3), quiet_);
  const std::string direct = bytes_of(session_.scene()), files = files_of(folder("a"));
  session_.undo(quiet_);
  const std::string before = bytes_of(session_.scene());
  const auto dropped = session_.preview(rough(0.9), quiet_);
  EXPECT_EQ(bytes_of(session_.scene()), before);
  const auto kept = session_.preview(rough(0.3), quiet_);
  EXPECT_EQ(bytes_of(kept->scene()), direct);
  session_.commit(*kept);
  EXPECT_EQ(bytes_of(session_.scene()), direct);
  EXPECT_THAT(message([&] { session_.commit(*dropped); }), HasSubstr("history has changed"));
  EXPECT_THAT(done(), ElementsAre("0002-material"));
}

TEST_F(LookTest, AStepOfTheHistoryIsSeenAsItWas) {
  FrameRequest request;
  request.camera = camera_of(0);
  const int width = request.camera.width, height = request.camera.height;
  std::vector<std::vector<uint8_t>> seen;
  const auto look = [&] { seen.push_back(picture(*session_.frame(request), width, height)); };
  look();
  session_.change_material(rough(0.9), quiet_);
  look();
  LightChoice dimmed;
  dimmed.scale = 0.5;
  session_.change_light(dimmed, quiet_);
  look();
  EXPECT_NE(seen[1], seen[2]);
  session_.undo(quiet_);
  for (size_t step = 0; step < seen.size(); ++step) {
    std::vector<uint8_t> bytes;
    for (const float v : session_.step_picture(request, step).data)
      bytes.push_back(uint8_t(std::lround(255 * v)));
    EXPECT_EQ(bytes, seen[step]) << step;
  }
  EXPECT_THAT(message([&] { session_.step_picture(request, 3); }), HasSubstr("no step 3"));
  EXPECT_EQ(done().size(), 1u);
}

TEST_F(LookTest, ASliderThatIsDraggedIsOneStep) {
  session_.edit(rough(0.3), quiet_);
  session_.edit(rough(0.5), quiet_, true);
  session_.edit(rough(0.7), quiet_, true);
  EXPECT_THAT(done(), ElementsAre("0003-material"));
  EXPECT_EQ(session_.scene().layers.size(), 1u);
  EXPECT_EQ(session_.scene().layers[0].material.roughness, 0.7f);
  EXPECT_FALSE(std::filesystem::exists(folder("a") / "edits" / "0001-material"));
  LightChoice turned;
  turned.rotate_degrees = 20;
  EXPECT_THAT(message([&] { session_.edit(turned, quiet_, true); }), HasSubstr("nothing to amend"));
  session_.undo(quiet_);
  EXPECT_THAT(message([&] { session_.edit(rough(0.1), quiet_, true); }), HasSubstr("nothing to amend"));
}

TEST_F(LookTest, TheHistoryGoesAnywhereAndGivesBackWhatWasDisplaced) {
  std::vector<std::string> states{bytes_of(session_.scene())};
  for (const double r : {0.2, 0.4, 0.6}) {
    session_.edit(rough(r), quiet_);
    states.push_back(bytes_of(session_.scene()));
  }
  for (const size_t step : {1u, 3u, 0u, 2u}) {
    session_.go_to(step, quiet_);
    EXPECT_EQ(bytes_of(session_.scene()), states[step]);
  }
  session_.rename("0002-material", "matt");
  session_.paint(scribble(0, {0.8f, 0.1f, 0.1f}, 6), quiet_);
  const std::vector<LogEntry> log = session_.log();
  ASSERT_EQ(log.size(), 4u);
  EXPECT_EQ(log[1].name, "matt");
  EXPECT_TRUE(log[3].set_aside);
  EXPECT_EQ(log[3].id, "0003-material");
  session_.restore("0003-material", quiet_);
  EXPECT_EQ(bytes_of(session_.scene()), states[3]);
  EXPECT_EQ(bytes_of(scene("a")), states[3]);
  session_.forget_set_aside();
  EXPECT_EQ(session_.log().size(), 3u);
}

TEST_F(LookTest, TilesAreThePictureThatRenderWrites) {
  session_.paint(scribble(0, {0.8f, 0.1f, 0.1f}, 6), quiet_);
  RenderRequest request;
  request.out = temp_.path() / "out";
  const std::filesystem::path cameras = temp_.path() / "cameras.json";
  Json camera = camera_json(camera_of(0));
  camera["name"] = "one";
  write_file_atomic(cameras, Json{{"cameras", {camera}}}.dump());
  request.cameras = CameraFile{cameras};
  for (const int samples : {1, 2}) {
    request.samples = samples;
    session_.render(request, quiet_);
    const Image want = read_image(request.out / "rgb" / "one.png");
    FrameRequest look;
    look.camera = read_camera(cameras);
    look.samples = samples;
    const auto frame = session_.frame(look);
    const std::vector<uint8_t> got = picture(*frame, kSize, kSize);
    for (size_t i = 0; i < got.size(); ++i) ASSERT_EQ(float(got[i]) / 255, want.data[i]) << i;
  }
}

// A page fetches only what an edit has changed.
TEST_F(LookTest, KeysOfPacksChangeWithThePacks) {
  const char* const kinds[] = {"tables", "shape", "coarse", "look", "light", "vertex_light"};
  const auto packs = [&] {
    std::map<std::string, std::string> all;
    for (const char* kind : kinds) all[kind] = session_.view_pack(kind);
    return all;
  };
  const auto changed_by = [&](const std::function<void()>& edit) {
    const Json keys = session_.view_keys();
    const auto before = packs();
    edit();
    const Json new_keys = session_.view_keys();
    const auto after = packs();
    std::string changed;
    for (const char* kind : kinds) {
      if (before.at(kind) != after.at(kind)) {
        EXPECT_NE(keys[kind], new_keys[kind]) << kind;
      }
      if (keys[kind] != new_keys[kind]) changed += std::string(kind) + ' ';
    }
    return changed;
  };
  EXPECT_EQ(changed_by([&] { session_.paint(scribble(0, {0.8f, 0.1f, 0.1f}, 6), quiet_); }), "look ");
  const Json painted = session_.view_keys();
  session_.change_light({"", 30, EnvConvention::by_up_axis, 1}, quiet_);
  EXPECT_EQ(changed_by([&] { session_.undo(quiet_); }), "light vertex_light ");
  EXPECT_EQ(session_.view_keys(), painted);
  EXPECT_EQ(changed_by([&] {
              session_.deform({PointDrag{{0, -0.7, 0}, {0, -0.85, 0}}, 0.35, ""}, quiet_);
            }),
            "shape coarse look vertex_light ");
  EXPECT_THAT(message([&] { session_.view_pack("color"); }), HasSubstr("no pack"));
}

// A browser keeps packs by their keys, also when another object is opened at the same address.
TEST_F(LookTest, ObjectsHaveKeysOfTheirOwn) {
  const Json keys = session_.view_keys();
  Scene other = sphere_with_handlers();
  other.material = Material{0.9f, 0.5f, 0};
  Project::create(temp_.path() / "other", {}, three_views(), false).save_base(other);
  Session session("cpu");
  session.open(temp_.path() / "other", Session::Access::read);
  for (const char* kind : {"shape", "look", "vertex_light"})
    EXPECT_NE(session.view_keys()[kind], keys[kind]) << kind;
}

TEST_F(LookTest, TellsWhatIsUnderThePointer) {
  add_part("cap", {0, -kSphereRadius, 0}, 0.4f);
  const auto p = session_.pick(camera_of(0), {24, 24});
  ASSERT_TRUE(p);
  EXPECT_NEAR(length(p->position), kSphereRadius, 1e-3);
  EXPECT_NEAR(dot(p->normal, p->position) / kSphereRadius, 1, 1e-3);
  EXPECT_NEAR(p->depth, length(camera_of(0).center) - kSphereRadius, 0.02);
  EXPECT_THAT(p->parts, ElementsAre("cap"));
  EXPECT_EQ(p->albedo.size(), 7u);
  EXPECT_FALSE(session_.pick(camera_of(0), {0.5, 0.5}));
  const Image mask = session_.part_picture(camera_of(0), "cap");
  EXPECT_EQ(mask.at(24, 24)[0], 1);
  EXPECT_EQ(mask.at(0, 0)[0], 0);
}

}  // namespace
}  // namespace cei3d
