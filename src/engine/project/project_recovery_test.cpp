// SPDX-License-Identifier: Apache-2.0
// What is left of a project when the program is killed, the disk is full, or files are damaged.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>

#include "engine/project/test_project.h"

namespace cei3d {
namespace {

using ::testing::HasSubstr;

// Names and sizes of all files.
std::string listing(const fs::path& folder) {
  std::string out;
  std::error_code gone;  // a file that is removed meanwhile
  for (auto it = fs::recursive_directory_iterator(folder, gone); it != fs::recursive_directory_iterator();
       it.increment(gone))
    out += fmt::format("{} {}\n", it->path().string(), it->is_regular_file(gone) ? it->file_size(gone) : 0);
  return out;
}

// kill -9 as soon as so many changes of the folder were seen.
void kill_after_changes(pid_t child, const fs::path& folder, int changes) {
  std::string now = listing(folder);
  while (changes > 0 && ::waitpid(child, nullptr, WNOHANG) == 0) {
    std::string next = listing(folder);
    changes -= next != now;
    now = std::move(next);
  }
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
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
    kill_after_changes(child, folder(), 1 + 2 * round);
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
    kill_after_changes(child, folder(), round);
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

// Copying what such a file holds would take more of the stack than there is.
TEST_F(ProjectTest, JsonThatIsNestedTooDeepIsNamed) {
  make_with_base();
  for (const char* name : {"project.json", "stack.json", "dataset.json", "base/scene.json"}) {
    const std::string before = read_file(folder() / name);
    write_file_atomic(folder() / name, std::string(300'000, '[') + std::string(300'000, ']'));
    EXPECT_THAT(message_of([&] { Project::open(folder(), Project::Mode::read).base(); }),
                testing::AllOf(HasSubstr(fs::path(name).filename().string()), HasSubstr("nested too deep")));
    write_file_atomic(folder() / name, before);
  }
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

}  // namespace
}  // namespace cei3d
