// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "engine/batch/csv.h"
#include "engine/batch/launchers.h"
#include "engine/batch/status.h"
#include "engine/batch/work.h"

namespace cei3d {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

BatchManifest stubs(int n) {
  std::vector<Json> lines;
  for (int i = 0; i < n; ++i)
    lines.push_back({{"id", fmt::format("o{}", i)}, {"steps", {"stub"}}, {"stub_seconds", 0.002}});
  return BatchManifest::of(lines);
}

class BatchTest : public testing::Test {
 protected:
  fs::path item(const std::string& id) const { return batch_item_folder(catalog.folder(), id); }
  BatchResult work(const BatchManifest& m, size_t i) {
    return batch_work(catalog, m, i, session, quiet).result;
  }

  TempFolder folder;
  BatchCatalog catalog{folder.path() / "catalog"};
  Session session{"cpu", 1};
  Progress quiet;
};

TEST_F(BatchTest, AnObjectIsMadeOnceAndAgainWhenItsOptionsChange) {
  EXPECT_EQ(work(stubs(1), 0), BatchResult::done);
  EXPECT_EQ(work(stubs(1), 0), BatchResult::up_to_date);
  const BatchManifest other =
      BatchManifest::of({{{"id", "o0"}, {"steps", {"stub"}}, {"stub_seconds", 0.003}}});
  EXPECT_EQ(work(other, 0), BatchResult::done);
  EXPECT_EQ(read_batch_state(item("o0"))->attempt, 2);
}

TEST_F(BatchTest, ManyWorkersMakeEachObjectOnce) {
  const BatchManifest m = stubs(20);
  std::vector<std::vector<BatchWorkReport>> reports(8);
  std::vector<std::thread> workers;
  for (auto& mine : reports)
    workers.emplace_back([&] {
      Session own("cpu", 1);
      Progress silent;
      mine = batch_claim(catalog, m, own, silent);
    });
  for (std::thread& w : workers) w.join();
  std::multiset<std::string> made;
  for (const auto& mine : reports)
    for (const BatchWorkReport& r : mine) made.insert(r.id);
  EXPECT_EQ(made.size(), 20u);
  EXPECT_EQ(std::set<std::string>(made.begin(), made.end()).size(), 20u);
  EXPECT_EQ(batch_status(catalog, m).done, 20u);
}

TEST_F(BatchTest, ASlowWorkerThatWasReplacedCanPublishNothing) {
  const BatchTiming slow{1000, 0.01}, quick{0.02, 0.01};
  const auto first = BatchAttempt::take(catalog.folder(), "o0", slow);
  ASSERT_TRUE(first);
  write_file_atomic(first->work() / "stub" / "half", "of the first");
  std::this_thread::sleep_for(std::chrono::milliseconds(30));
  const auto second = BatchAttempt::take(catalog.folder(), "o0", quick);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->number(), 2);
  EXPECT_EQ(read_file(second->work() / "stub" / "half"), "of the first");
  write_file_atomic(first->work() / "stub" / "half", "of the first, later");
  EXPECT_EQ(error_of([&] { first->publish("stub"); }).code(), ErrorCode::again);
  EXPECT_EQ(error_of([&] { first->publish_state({}); }).code(), ErrorCode::again);
  EXPECT_FALSE(fs::exists(item("o0") / "state.json"));
  EXPECT_EQ(read_file(second->work() / "stub" / "half"), "of the first");
}

TEST_F(BatchTest, AWorkerThatTouchesItsFileKeepsItWhateverTheClocksSay) {
  const BatchTiming timing{0.02, 10};
  const auto first = BatchAttempt::take(catalog.folder(), "o0", timing);
  ASSERT_TRUE(first);
  // To others, whose clocks are an hour ahead, the file looks old until it is touched.
  EXPECT_FALSE(BatchAttempt::take(catalog.folder(), "o0", {0.1, 0}));
}

TEST_F(BatchTest, WorkersThatWereKilledAreCountedAndAtLastBelieved) {
  const BatchManifest m = stubs(1);
  const auto killed = [&](int n) {
    const Json record{{"host", "h"}, {"space", this_process().space}, {"pid", 1}, {"started", 1}, {"job", ""},
                      {"restart", 0}};
    fs::create_directories(item("o0"));
    write_new_file(item("o0") / fmt::format("attempt-{:04}", n), record.dump());
  };
  for (int n = 1; n <= 4; ++n) killed(n);
  EXPECT_EQ(work(m, 0), BatchResult::failed);
  EXPECT_THAT(read_batch_state(item("o0"))->reason, HasSubstr("killed 4 times"));
  EXPECT_EQ(work(m, 0), BatchResult::failed);
  EXPECT_EQ(read_batch_state(item("o0"))->attempt, 5);
  EXPECT_EQ(batch_retry(catalog, m, ""), 1u);
  EXPECT_EQ(work(m, 0), BatchResult::done);
}

TEST_F(BatchTest, ACaptureThatIsNotThereFailsForGoodUnlessItWasPlanned) {
  Json line{{"id", "o0"}, {"capture", (folder.path() / "gone").string()}, {"steps", {"check"}}};
  EXPECT_EQ(work(BatchManifest::of({line}), 0), BatchResult::failed);
  line["id"] = "o1";
  line["planned"] = {{"views", 3}};
  EXPECT_EQ(work(BatchManifest::of({line}), 0), BatchResult::retryable);
}

TEST_F(BatchTest, ACancelledCatalogIsLeftAlone) {
  write_file_atomic(batch_cancel_file(catalog.folder()), "");
  EXPECT_EQ(work(stubs(1), 0), BatchResult::interrupted);
  EXPECT_FALSE(fs::exists(item("o0")));
}

TEST(BatchManifest, RefusesWhatItDoesNotUnderstand) {
  const auto said = [](const Json& line) { return message([&] { batch_item_from(line, "line 7"); }); };
  EXPECT_THAT(said({{"id", "a"}, {"capture", "c"}, {"smell", 1}}), HasSubstr("unknown key 'smell'"));
  EXPECT_THAT(said({{"id", "../a"}, {"capture", "c"}}), HasSubstr("cannot be an id"));
  EXPECT_THAT(said({{"id", "a"}, {"capture", "c"}, {"steps", {"exprot"}}}), HasSubstr("'export'"));
  EXPECT_THAT(said({{"id", "a"}}), HasSubstr("no 'capture'"));
  EXPECT_THAT(said({{"id", "a"}, {"capture", "c"}, {"unit_scale", 1e300}}), HasSubstr("'unit_scale'"));
  EXPECT_THAT(message([] { BatchManifest::of({{{"id", "a"}}, {{"id", "a"}}}); }), HasSubstr("twice"));
}

TEST(BatchManifest, ReadsTables) {
  const std::string table =
      "id,capture,iterations,export,tag.price\r\nmug,\"a, \"\"b\"\"\",40,glb;usdz,12\r\n";
  const Json line = lines_of_csv(table, "t").at(0);
  const Json expected{{"id", "mug"},
                      {"capture", "a, \"b\""},
                      {"options", {{"iterations", 40}}},
                      {"export", {"glb", "usdz"}},
                      {"tags", {{"price", "12"}}}};
  EXPECT_EQ(line, expected);
  EXPECT_EQ(csv_table(csv_line({"a,\"b\"\n", "c"}), "t").at(0), (std::vector<std::string>{"a,\"b\"\n", "c"}));
  EXPECT_EQ(lines_of_csv("id,capture\nm\xc3\xbcg,c\n", "t").at(0).at("id"), "m\xc3\xbcg");
  EXPECT_THAT(message([] { lines_of_csv("id,capture\nm\xfcg,c\n", "t"); }), HasSubstr("not UTF-8"));
}

TEST(Launchers, ArraysCoverEveryObjectOnce) {
  ClusterRun run;
  run.program = "/bin/true";
  run.objects = 25;
  run.array_size = 4;
  run.pack = 3;
  const TempFolder folder;
  run.catalog = folder.path();
  run.manifest = folder.path() / "m.jsonl";
  EXPECT_THAT(slurm_script(run, 0), HasSubstr("--array=0-3"));
  EXPECT_THAT(slurm_script(run, 24), HasSubstr("--array=0-0"));
  EXPECT_EQ(submit_to_slurm(run, true).size(), 3u);  // objects 0 to 11, 12 to 23, 24
}

}  // namespace
}  // namespace cei3d
