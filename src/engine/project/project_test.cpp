// SPDX-License-Identifier: Apache-2.0
#include "engine/project/project.h"

#include <gmock/gmock.h>
#include <sys/wait.h>

#include <fstream>

#include "core/math/rigid_motion.h"
#include "engine/capture/capture.h"
#include "engine/project/dataset.h"
#include "engine/project/test_project.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;

TEST_F(ProjectTest, ReopensAsItWas) {
  make_with_base();
  const Project p = Project::open(folder(), Project::Mode::read);
  EXPECT_EQ(p.head().normalization.scale, 0.5);
  EXPECT_EQ(p.head().normalization.center.z, 3);
  EXPECT_EQ(p.head().options["preset"], "fast");
  const Capture expected = small_capture(temp_.path() / "photos");
  ASSERT_EQ(p.capture().views.size(), expected.views.size());
  for (size_t i = 0; i < expected.views.size(); ++i) {
    const View &a = p.capture().views[i], &b = expected.views[i];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.split, b.split);
    EXPECT_EQ(a.image_path, b.image_path);
    EXPECT_EQ(a.mask_path, b.mask_path);
    EXPECT_EQ(a.camera.center.y, b.camera.center.y);  // doubles survive exactly
    EXPECT_EQ(a.camera.fx, b.camera.fx);
  }
  EXPECT_EQ(bytes_of(p.scene()), bytes_of(small_scene()));
}

// The camera of an object's view is where edits and renders see it from; what was given is still known.
TEST_F(ProjectTest, RefinedCamerasAreThoseOfItsViews) {
  const Vec3d center{0.25, 4, -1};
  {
    Project p = make();
    Scene scene = small_scene();
    scene.refined = {{{"train/r_000", rotation_of({0.1, 0, 0.2}), center}}, 1.02};
    p.save_base(scene);
    EXPECT_EQ(find_view(p.capture(), "train/r_000").camera.center.y, 4);
  }
  const Project p = Project::open(folder(), Project::Mode::read);
  const Capture given = small_capture(temp_.path() / "photos");
  const auto camera = [](const Capture& c, const char* name) { return find_view(c, name).camera; };
  EXPECT_EQ(camera(p.capture(), "train/r_000").center.x, center.x);
  EXPECT_EQ(camera(p.capture(), "train/r_000").world_from_cam.row[1].z, rotation_of({0.1, 0, 0.2}).row[1].z);
  EXPECT_EQ(camera(p.capture(), "test/r_002").center.x, camera(given, "test/r_002").center.x);
  EXPECT_EQ(camera(p.capture(), "test/r_002").fx, 1.02 * camera(given, "test/r_002").fx);
  EXPECT_EQ(camera(p.given_capture(), "train/r_000").center.x, camera(given, "train/r_000").center.x);
  EXPECT_EQ(camera(p.given_capture(), "train/r_000").fx, camera(given, "train/r_000").fx);
  EXPECT_EQ(capture_fingerprint(p.given_capture()), p.fingerprint());
}

// As objects of older programs are stored, which knew poses alone.
TEST_F(ProjectTest, WithoutARefinedFocalLengthThatOfTheCaptureIsRight) {
  Scene scene = small_scene();
  scene.refined.poses = {{"train/r_000", rotation_of({0.1, 0, 0.2}), {0, 4, 1}}};
  Tensors tensors;
  Json head = Json::object();
  save_scene(scene, tensors, head);
  EXPECT_FALSE(head.contains("focal"));
  EXPECT_EQ(load_scene(tensors, head).refined.focal, 1);
  head["focal"] = 0;
  EXPECT_THROW(load_scene(tensors, head), Error);
}

TEST_F(ProjectTest, KeepsTheExposuresOfItsViews) {
  {
    Project p = make();
    Scene scene = small_scene();
    scene.exposures = {{"train/r_000", {1.25f, 0.8f, 1 / 3.0f}}};
    p.save_base(scene);
  }
  const Scene scene = Project::open(folder(), Project::Mode::read).base();
  ASSERT_EQ(scene.exposures.size(), 1u);
  EXPECT_EQ(scene.exposures[0].view, "train/r_000");
  EXPECT_EQ(scene.exposures[0].factors.x, 1.25f);
  EXPECT_EQ(scene.exposures[0].factors.z, 1 / 3.0f);
}

TEST_F(ProjectTest, MovesTogetherWithItsCapture) {
  fs::create_directories(temp_.path() / "a/photos");
  Project::create(temp_.path() / "a/object", {}, small_capture(temp_.path() / "a/photos"), false);
  fs::rename(temp_.path() / "a", temp_.path() / "b");
  const Project p = Project::open(temp_.path() / "b/object", Project::Mode::read);
  EXPECT_EQ(p.capture().views[0].image_path, temp_.path() / "b/photos/train/r_000.png");
}

TEST_F(ProjectTest, EditsUndoRedoToggleGiveTheSameBytes) {
  Project p = make_with_base();
  std::vector<std::string> after = {bytes_of(p.scene())};
  for (int i = 0; i < 3; ++i) {
    add_paint(p, i + 10);
    after.push_back(bytes_of(p.scene()));
  }
  for (int i = 2; i >= 0; --i) {
    p.undo();
    EXPECT_EQ(bytes_of(p.scene()), after[i]);
  }
  for (int i = 1; i <= 3; ++i) {
    p.redo();
    EXPECT_EQ(bytes_of(Project::open(folder(), Project::Mode::read).scene()), after[i]);
  }
  EXPECT_FALSE(p.toggle("0002-paint"));
  EXPECT_EQ(p.scene().layers.size(), 2u);
  EXPECT_TRUE(p.toggle("0002-paint"));
  EXPECT_EQ(bytes_of(p.scene()), after[3]);
}

TEST_F(ProjectTest, ReadsOnlyLayersThatAreNew) {
  Project p = make_with_base();
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    add_paint(p, seed);
    EXPECT_EQ(p.scene().layers.size(), seed);
    EXPECT_EQ(p.scene_cache().layers_loaded(), seed);
  }
  p.undo();
  EXPECT_EQ(bytes_of(p.scene()), bytes_of(Project::open(folder(), Project::Mode::read).scene()));
  p.redo();
  EXPECT_EQ(bytes_of(p.scene()), bytes_of(Project::open(folder(), Project::Mode::read).scene()));
  EXPECT_EQ(p.scene_cache().layers_loaded(), 4u);
  for (int round = 0; round < 2; ++round) {
    p.toggle("0002-paint");  // those above it lie on another scene now
    EXPECT_EQ(bytes_of(p.scene()), bytes_of(Project::open(folder(), Project::Mode::read).scene()));
    EXPECT_EQ(p.scene_cache().layers_loaded(), 4u);
  }
}

TEST_F(ProjectTest, AnEditAfterUndoSetsAsideWhatWasUndone) {
  Project p = make_with_base();
  add_paint(p, 1);
  add_paint(p, 2);
  const std::string two = bytes_of(p.scene());
  p.undo();
  add_paint(p, 3);
  const std::vector<std::string> now = {"0001-paint", "0003-paint"}, then = {"0001-paint", "0002-paint"};
  EXPECT_EQ(p.stack().active(), now);
  EXPECT_TRUE(fs::exists(folder() / "edits/0002-paint"));
  Stack back = p.stack();
  back.restore("0002-paint");
  p.move_to(back, {{"do", "restore"}});
  EXPECT_EQ(p.stack().active(), then);
  EXPECT_EQ(bytes_of(Project::open(folder(), Project::Mode::read).scene()), two);
  back.restore("0003-paint");
  p.move_to(back, {{"do", "restore"}});
  p.forget_set_aside();
  EXPECT_EQ(p.stack().active(), now);
  EXPECT_FALSE(fs::exists(folder() / "edits/0002-paint"));
  EXPECT_EQ(files_below(folder() / "objects", ".safetensors").size(), 3u);  // base and two layers
  EXPECT_EQ(read_file(folder() / "edits/0003-paint/scribble.png"), "not really a picture");
  EXPECT_EQ(p.edit("0003-paint").params["view"], "train/r_000");
}

TEST_F(ProjectTest, RefusesTheSecondWriterButNotReaders) {
  const Project first = make_with_base();
  EXPECT_THAT(message_of([&] { Project::open(folder(), Project::Mode::write); }),
              HasSubstr("in use by another"));
  EXPECT_THROW(Project::open(folder(), Project::Mode::write), InUseError);
  EXPECT_NO_THROW(Project::open(folder(), Project::Mode::read).scene());
}

TEST_F(ProjectTest, SaysWhereTheEditorIsThatHasIt) {
  make_with_base();
  const auto refusal = [&] { return message_of([&] { Project::open(folder(), Project::Mode::write); }); };
  {
    const Project editor = Project::open(folder(), Project::Mode::write);
    editor.say_address("http://127.0.0.1:7861");
    EXPECT_THAT(refusal(), HasSubstr("in use by another cei3d that changes it, the editor at "
                                     "http://127.0.0.1:7861;"));
    editor.say_address("no address\n");
    EXPECT_THAT(refusal(), HasSubstr("changes it; wait"));
    editor.say_address("http://127.0.0.1:7861");
  }
  const Project command = Project::open(folder(), Project::Mode::write);
  EXPECT_THAT(refusal(), HasSubstr("changes it; wait"));  // the editor has ended
}

TEST_F(ProjectTest, NewerFormatIsRefusedAndUntouched) {
  make_with_base();
  fs::remove(folder() / ".lock");
  Json head = Json::parse(read_file(folder() / "project.json"));
  head["version"] = kProjectVersion + 1;
  head["surprise"] = "from the future";
  write_file_atomic(folder() / "project.json", head.dump());
  const std::string before = read_file(folder() / "project.json");
  for (const auto mode : {Project::Mode::read, Project::Mode::write})
    EXPECT_THAT(message_of([&] { Project::open(folder(), mode); }), HasSubstr("newer program"));
  EXPECT_THAT(message_of([&] { make(true); }), HasSubstr("newer program"));
  EXPECT_EQ(read_file(folder() / "project.json"), before);
  EXPECT_EQ(files_below(folder() / "base", "scene.json").size(), 1u);
}

// An edit had one result, whatever lay below it.
TEST_F(ProjectTest, EditsOfTheFirstFormatAreRead) {
  std::string before;
  {
    Project p = make_with_base();
    add_paint(p, 1);
    before = bytes_of(p.scene());
  }
  const auto change = [&](const char* file, const std::function<void(Json&)>& how) {
    Json j = Json::parse(read_file(folder() / file));
    how(j);
    write_file_atomic(folder() / file, j.dump());
  };
  change("project.json", [](Json& j) { j["version"] = 1; });
  change("edits/0001-paint/edit.json", [](Json& j) {
    j["result"] = j["results"].front();
    j["result"].erase("changes");
    j.erase("results");
    j.erase("depends");
  });
  Project p = Project::open(folder(), Project::Mode::write);
  EXPECT_EQ(bytes_of(p.scene()), before);
  EXPECT_EQ(p.edit("0001-paint").params["view"], "train/r_000");
  p.undo();
  p.redo();
  EXPECT_EQ(bytes_of(p.scene()), before);
  change("edits/0001-paint/edit.json", [](Json& j) { j["result"]["surprise"] = 1; });
  EXPECT_THAT(message_of([&] { Project::open(folder(), Project::Mode::read).scene(); }),
              HasSubstr("unknown key 'surprise'"));
}

TEST_F(ProjectTest, UnknownKeysAreNamed) {
  {
    Project p = make_with_base();
    add_paint(p, 1);
  }
  const auto reading = [&] {
    const Project p = Project::open(folder(), Project::Mode::read);
    p.scene();
    p.edit("0001-paint");
  };
  for (const auto& [name, place] :
       std::vector<std::pair<std::string, std::string>>{{"project.json", ""},
                                                        {"project.json", "/normalization"},
                                                        {"dataset.json", ""},
                                                        {"dataset.json", "/views/0"},
                                                        {"dataset.json", "/views/1/camera"},
                                                        {"stack.json", ""},
                                                        {"stack.json", "/edits/0"},
                                                        {"base/scene.json", ""},
                                                        {"base/scene.json", "/head"},
                                                        {"base/scene.json", "/head/material"},
                                                        {"base/scene.json", "/head/sdf"},
                                                        {"base/scene.json", "/head/handlers"},
                                                        {"edits/0001-paint/edit.json", ""}}) {
    const std::string good = read_file(folder() / name);
    Json bad = Json::parse(good);
    bad[Json::json_pointer(place)]["surprise"] = 1;
    write_file_atomic(folder() / name, bad.dump());
    EXPECT_THAT(message_of(reading), HasSubstr("unknown key 'surprise'")) << name << place;
    EXPECT_THAT(message_of(reading), HasSubstr(name)) << place;
    write_file_atomic(folder() / name, good);
  }
  EXPECT_NO_THROW(reading());
}

TEST_F(ProjectTest, DoesNotTakeAFolderThatHoldsSomethingElse) {
  fs::create_directories(folder());
  write_file_atomic(folder() / "thesis.tex", "irreplaceable");
  for (const bool replace : {false, true})
    EXPECT_THAT(message_of([&] { make(replace); }), HasSubstr("is not a project"));
  EXPECT_EQ(files_below(folder(), "").size(), 1u);
}

TEST_F(ProjectTest, ReplacesAProjectOnlyWhenAsked) {
  {
    Project p = make_with_base();
    add_paint(p, 1);
  }
  write_file_atomic(folder() / "exports/mine.glb", "keep");
  EXPECT_THAT(message_of([&] { make(); }), HasSubstr("force"));
  const Project p = make(true);
  EXPECT_FALSE(p.has_base());
  EXPECT_TRUE(p.stack().entries().empty());
  EXPECT_EQ(read_file(folder() / "exports/mine.glb"), "keep");
  EXPECT_THAT(message_of([&] { p.scene(); }), HasSubstr("no finished object"));
}

TEST_F(ProjectTest, DiscardsOnlyWhatHoldsNothing) {
  {
    Project p = make();
    p.new_run("reconstruct");
    p.add_history({{"do", "reconstruct"}});
    p.discard_if_empty();
  }
  EXPECT_FALSE(fs::exists(folder()));
  Project p = make();
  p.save_checkpoint({{{"step", 1}}, {{"x", {{1}, {1}, {}}}}});
  p.discard_if_empty();
  EXPECT_TRUE(p.latest_checkpoint());
}

TEST_F(ProjectTest, HistoryGrowsByLines) {
  Project p = make_with_base();
  add_paint(p, 1);
  p.undo();
  std::ifstream in(folder() / "history.jsonl");
  std::vector<std::string> done;
  for (std::string line; std::getline(in, line);) done.push_back(Json::parse(line)["do"]);
  EXPECT_EQ(done, (std::vector<std::string>{"paint", "undo"}));
}

}  // namespace
}  // namespace cei3d
