// SPDX-License-Identifier: Apache-2.0
#include "engine/project/project.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <functional>
#include <thread>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

template <class F>
std::string message_of(F run) {
  try {
    run();
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

Capture small_capture(const fs::path& root) {
  Capture c;
  c.root = root;
  c.format = "nerf-synthetic";
  for (int i = 0; i < 3; ++i) {
    View v;
    v.name = "train/r_00" + std::to_string(i);
    v.camera.width = 8;
    v.camera.height = 6;
    v.camera.fx = v.camera.fy = 11.5 + i;
    v.camera.cx = 4.25;
    v.camera.cy = 3;
    v.camera.center = {0.1 * i, 1.0 / 3, -4};
    v.image_path = root / (v.name + ".png");
    c.views.push_back(v);
  }
  c.views.back().split = Split::test;
  c.views.back().name = "test/r_002";
  return c;
}

std::shared_ptr<const Field> small_field(int outputs, uint64_t seed) {
  FieldConfig c;
  c.encoding.levels = 2;
  c.encoding.base_resolution = 4;
  c.encoding.finest_resolution = 8;
  c.encoding.log2_table = 6;
  c.width = 32;
  c.outputs = outputs;
  c.output_activation = Activation::sigmoid;
  return std::make_shared<Field>(c, seed);
}

Scene small_scene() {
  Scene s;
  s.normalization = {{0.25, -1, 1.0 / 3}, 0.7};
  s.up = {0, 1, 0};
  s.sdf = small_field(1, 1);
  s.albedo = small_field(3, 2);
  s.light.lobes = {{{0, 0, 1}, 3.5f, {1, 2, 3}}, {{1, 0, 0}, 20, {0.5f, 0, 0.25f}}};
  s.material = Material{0.21f, 0.4f, 1};
  auto points = std::make_shared<HandlerPoints>();
  points->positions = {{0, 0, 0.5f}, {0.5f, 0, 0}};
  points->normals = {{0, 0, 1}, {1, 0, 0}};
  points->footprints = {0.01f, 0.02f};
  points->spacing = 0.03f;
  s.handlers = points;
  return s;
}

EditLayer small_layer(const std::string& id, uint64_t seed) {
  EditLayer layer;
  layer.id = id;
  Rng rng(seed, 0, 0);
  layer.region = Region({{{rng.uniform(), 0, 0.5f}}, {{0, 0, 1}}, {0.1f}});
  layer.albedo = small_field(3, seed);
  return layer;
}

// Scene as bytes: equal bytes, equal scenes.
std::string bytes_of(const Scene& scene) {
  Tensors tensors;
  Json head = Json::object();
  save_scene(scene, tensors, head);
  std::string bytes = tensors_to_bytes(tensors) + head.dump();
  for (const EditLayer& layer : scene.layers) {
    Tensors t;
    Json h = Json::object();
    save_layer(layer, t, h);
    bytes += tensors_to_bytes(t) + h.dump();
  }
  return bytes;
}

EditRecord paint_record(const Project& project) {
  EditRecord r;
  r.op = "paint";
  r.id = project.stack().next_id(r.op);
  r.params = {{"view", "train/r_000"}, {"seed", 1}};
  r.report = {{"points", 1}};
  r.inputs = {{"scribble.png", "not really a picture"}};
  return r;
}

void add_paint(Project& project, uint64_t seed) {
  const EditRecord r = paint_record(project);
  project.add_edit(r, small_layer(r.id, seed));
}

std::vector<fs::path> files_below(const fs::path& folder, const std::string& suffix) {
  std::vector<fs::path> found;
  for (const auto& e : fs::recursive_directory_iterator(folder))
    if (e.is_regular_file() && e.path().string().ends_with(suffix)) found.push_back(e.path());
  return found;
}

class ProjectTest : public ::testing::Test {
 protected:
  fs::path folder() const { return temp_.path() / "object"; }
  Project make(bool replace = false) {
    return Project::create(folder(), {{{1, 2, 3}, 0.5}, {{"preset", "fast"}}},
                           small_capture(temp_.path() / "photos"), replace);
  }
  Project make_with_base() {
    Project p = make();
    p.save_base(small_scene());
    return p;
  }
  TempFolder temp_;
};

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

TEST_F(ProjectTest, AddsToTheSceneInMemoryOnlyWhatIsNew) {
  Project p = make_with_base();
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    add_paint(p, seed);
    EXPECT_EQ(p.scene().layers.size(), seed);
    EXPECT_EQ(p.scene_cache().layers_added(), seed);
  }
  p.undo();
  EXPECT_EQ(bytes_of(p.scene()), bytes_of(Project::open(folder(), Project::Mode::read).scene()));
  p.redo();
  EXPECT_EQ(bytes_of(p.scene()), bytes_of(Project::open(folder(), Project::Mode::read).scene()));
  EXPECT_EQ(p.scene_cache().layers_added(), 4u);
  p.toggle("0002-paint");  // those above it lie on another scene now
  EXPECT_EQ(bytes_of(p.scene()), bytes_of(Project::open(folder(), Project::Mode::read).scene()));
  EXPECT_EQ(p.scene_cache().layers_added(), 6u);
  p.toggle("0002-paint");
  EXPECT_EQ(bytes_of(p.scene()), bytes_of(Project::open(folder(), Project::Mode::read).scene()));
  EXPECT_EQ(p.scene_cache().layers_added(), 6u);
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

TEST_F(ProjectTest, KeepsTheLastTwoCheckpoints) {
  Project p = make();
  EXPECT_FALSE(p.latest_checkpoint());
  for (int i = 1; i <= 5; ++i) p.save_checkpoint({{{"step", i}}, {{"x", {{2}, {float(i), 0.5f}, {}}}}});
  EXPECT_EQ(p.latest_checkpoint()->head["step"], 5);
  EXPECT_EQ(p.latest_checkpoint()->tensors.at("x").f32[0], 5);
  EXPECT_EQ(files_below(folder() / "base", ".ckpt.json").size(), 2u);
  EXPECT_EQ(files_below(folder() / "objects", ".safetensors").size(), 2u);
  EXPECT_EQ(read_file(folder() / "base/latest"), "000005.ckpt.json\n");
}

TEST_F(ProjectTest, FallsBackToTheOlderCheckpointWhenTheNewestIsDamaged) {
  Project p = make();
  for (int i = 1; i <= 2; ++i) p.save_checkpoint({{{"step", i}}, {{"x", {{1}, {float(i)}, {}}}}});
  const Json newest = Json::parse(read_file(folder() / "base/000002.ckpt.json"));
  const std::string hash = newest["object"];
  fs::remove(folder() / "objects" / hash.substr(0, 2) / (hash.substr(2) + ".safetensors"));
  EXPECT_EQ(p.latest_checkpoint()->head["step"], 1);
}

TEST_F(ProjectTest, SurvivesKillAtAnyMoment) {
  make().save_checkpoint({{{"step", 0}}, {{"x", {{1}, {0}, {}}}}});
  for (int round = 0; round < 12; ++round) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {  // writes states whose tensor is a function of the step until it is killed
      Project p = Project::open(folder(), Project::Mode::write);
      const auto last = p.latest_checkpoint();
      for (int step = last ? last->head["step"].get<int>() + 1 : 1;; ++step)
        p.save_checkpoint({{{"step", step}}, {{"x", {{5000}, std::vector<float>(5000, float(step)), {}}}}});
    }
    ::usleep(3000 + 1700 * round);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    const Project p = Project::open(folder(), Project::Mode::write);
    const auto state = p.latest_checkpoint();
    ASSERT_TRUE(state);
    const std::vector<float>& x = state->tensors.at("x").f32;
    EXPECT_EQ(x, std::vector<float>(x.size(), float(state->head["step"].get<int>())));
  }
}

// What is written when a kill comes is lost; what stood before stands, whole.
TEST_F(ProjectTest, EditsSurviveKillAtAnyMoment) {
  make_with_base();
  for (int round = 0; round < 12; ++round) {
    const std::string before = read_file(folder() / "stack.json");
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      Project p = Project::open(folder(), Project::Mode::write);
      for (uint64_t i = 0;; ++i) {
        add_paint(p, i);
        p.toggle(p.stack().entries().front().id);
        if (i % 3 == 2) p.undo();
      }
    }
    while (read_file(folder() / "stack.json") == before) ::usleep(200);  // one edit stands
    ::usleep(700 * round);
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    Project p = Project::open(folder(), Project::Mode::write);
    const size_t edits = p.stack().active().size();
    EXPECT_EQ(p.scene().layers.size(), edits);
    for (const StackEntry& e : p.stack().entries()) EXPECT_EQ(p.edit_inputs(e.id).size(), 1u);
    EXPECT_GE(p.stack().entries().size(), 1u);
    add_paint(p, 99);  // and the project goes on
    EXPECT_EQ(p.scene().layers.size(), edits + 1);
    p.undo();
  }
}

TEST_F(ProjectTest, RefusesTheSecondWriterButNotReaders) {
  const Project first = make_with_base();
  EXPECT_THAT(message_of([&] { Project::open(folder(), Project::Mode::write); }),
              HasSubstr("in use by another"));
  EXPECT_NO_THROW(Project::open(folder(), Project::Mode::read).scene());
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

TEST_F(ProjectTest, DamagedObjectsAreNamed) {
  make_with_base();
  const fs::path object = files_below(folder() / "objects", ".safetensors").at(0);
  const std::string good = read_file(object);
  const auto reading = [&] { Project::open(folder(), Project::Mode::read).scene(); };

  write_file_atomic(object, good.substr(0, good.size() / 2));
  EXPECT_THAT(message_of(reading), HasSubstr("is damaged"));
  std::string flipped = good;
  flipped[good.size() / 2] ^= 4;
  write_file_atomic(object, flipped);
  EXPECT_THAT(message_of(reading), HasSubstr("is damaged"));
  EXPECT_THAT(message_of(reading), HasSubstr(object.filename().string()));
  fs::remove(object);
  EXPECT_THAT(message_of(reading), HasSubstr("is missing"));
  write_file_atomic(object, good);
  EXPECT_NO_THROW(reading());
}

TEST_F(ProjectTest, DamagedJsonIsNamed) {
  {
    Project p = make_with_base();
    add_paint(p, 1);
  }
  for (const char* name :
       {"project.json", "dataset.json", "stack.json", "base/scene.json", "edits/0001-paint/edit.json"}) {
    const std::string good = read_file(folder() / name);
    for (const std::string& bad : {good.substr(0, good.size() / 2), std::string("{}"), std::string("[]"),
                                   std::string("null"), std::string("\xff\xfe"), std::string()}) {
      write_file_atomic(folder() / name, bad);
      EXPECT_THAT(message_of([&] { Project::open(folder(), Project::Mode::read).scene(); }),
                  HasSubstr(fs::path(name).filename().string()))
          << bad.substr(0, 40);
    }
    write_file_atomic(folder() / name, good);
  }
  EXPECT_NO_THROW(Project::open(folder(), Project::Mode::read).scene());
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
  EXPECT_THAT(message_of([&] { make(); }), HasSubstr("--force"));
  const Project p = make(true);
  EXPECT_FALSE(p.has_base());
  EXPECT_TRUE(p.stack().entries().empty());
  EXPECT_EQ(read_file(folder() / "exports/mine.glb"), "keep");
  EXPECT_THAT(message_of([&] { p.scene(); }), HasSubstr("no finished object"));
}

// A file size limit makes writes fail as a full disk does; in a child, since it holds for the whole process.
TEST_F(ProjectTest, AWriteThatFailsLeavesTheOldState) {
  make_with_base();
  const std::string before = bytes_of(Project::open(folder(), Project::Mode::read).scene());
  const pid_t child = ::fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{512, 512};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const std::string edit = message_of([&] {
      Project p = Project::open(folder(), Project::Mode::write);
      add_paint(p, 1);
    });
    const std::string fresh =
        message_of([&] { Project::create(folder().string() + "2", {}, small_capture(folder()), false); });
    ::_exit(edit.find("Cannot write") == 0 && fresh.find("Cannot write") == 0 ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  EXPECT_FALSE(fs::exists(folder().string() + "2"));
  const Project p = Project::open(folder(), Project::Mode::read);
  EXPECT_EQ(bytes_of(p.scene()), before);
  EXPECT_TRUE(p.stack().entries().empty());
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
