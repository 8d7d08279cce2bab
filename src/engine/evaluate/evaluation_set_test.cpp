// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/evaluation_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/capture/capture.h"
#include "engine/capture/test_capture.h"
#include "engine/evaluate/own_edits.h"
#include "engine/io/image_file.h"
#include "engine/project/project.h"
#include "engine/render/sphere_scene.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kSize = 48;

EvaluationReport report_of(double psnr, double edit_psnr) {
  EvaluationReport r;
  r.object.scores.psnr = psnr;
  r.object.scores.ssim = 0.5;
  EvaluationRow paint;
  paint.scores.edit = EditScore{};
  paint.scores.edit->rest = RestScore{edit_psnr, 0.9, {}, {}, 10, 1};
  paint.seconds = 2;
  r.paint = {paint};
  return r;
}

TEST(EvaluationSet, TablesHaveMeansOfSeedsThenOfCaptures) {
  EvaluationSetReport set;
  set.captures = {{"cow", "", {report_of(30, 40), report_of(34, 42)}},
                  {"pot", "", {report_of(20, 30)}},
                  {"duck", "no cameras", {}}};
  const std::string text = set.markdown();
  EXPECT_THAT(text, HasSubstr("32.00 ± 2.83"));  // sqrt(8)
  EXPECT_THAT(text, HasSubstr("| **mean** | 26.00 |"));
  EXPECT_THAT(text, HasSubstr("| **mean** | 35.50 |"));
  EXPECT_THAT(text, HasSubstr("duck could not be evaluated: no cameras"));
  const Json j = set.json();
  EXPECT_EQ(j["means"]["views"]["psnr"], 26);
  EXPECT_EQ(j["means"]["paint"]["rest_psnr"], 35.5);
  EXPECT_EQ(j["captures"].size(), 3u);
}

EvaluationRow scored(const char* name, const char* what, double psnr) {
  EvaluationRow r;
  r.name = name;
  r.what = what;
  r.scores.psnr = psnr;
  r.scores.ssim = 0.5;
  r.scores.edit = EditScore{};
  r.scores.edit->rest = RestScore{psnr + 10, 0.9, {}, {}, 10, 1};
  r.seconds = 4;
  return r;
}

// What one capture lacks, or what was skipped there, is left out of the means.
TEST(EvaluationSet, TablesOfApplicationsAndOfFewerAndSmallerPhotographs) {
  EvaluationReport cow = report_of(30, 44), pot = report_of(20, 30);
  cow.applications = {scored("light", "the light turned", 30), scored("drag", "a drag", 20)};
  pot.applications = {scored("light", "the light turned", 20), {"drag", "a drag", "no surface", 0, {}, {}}};
  cow.views = {scored("views-50", "50 views", 29), scored("views-12", "12 views", 21)};
  pot.views = {{"views-50", "50 views", "the capture has 20", 0, {}, {}}, scored("views-12", "12 views", 11)};
  cow.sizes = {scored("size-2", "1/2 of the size", 25)};
  EvaluationSetReport set;
  set.captures = {{"cow", "", {cow}}, {"pot", "", {pot}}};
  const std::string text = set.markdown();
  EXPECT_THAT(text, HasSubstr("## Another edit: the light turned\n"));
  EXPECT_THAT(text, HasSubstr("| **mean** | 35.00 |"));  // of 40 and 30
  EXPECT_THAT(text, HasSubstr("## Another edit: a drag\n"));
  EXPECT_THAT(text, HasSubstr("## Fewer photographs: PSNR on white\n\n| capture | 50 views | 12 views |\n"));
  EXPECT_THAT(text, HasSubstr("| [cow](cow/) | 29.00 | 21.00 |\n| [pot](pot/) | - | 11.00 |\n"));
  EXPECT_THAT(text, HasSubstr("| **mean** | 29.00 | 16.00 |"));
  EXPECT_THAT(text, HasSubstr("## Smaller photographs: SSIM\n\n| capture | 1/2 of the size |\n"));
  const Json means = set.json()["means"];
  EXPECT_EQ(means["applications"]["light"]["rest_psnr"], 35);
  EXPECT_EQ(means["applications"]["drag"]["rest_psnr"], 30);
  EXPECT_EQ(means["fewer_views"]["views-12"]["psnr"], 16);
  EXPECT_EQ(means["sizes"]["size-2"]["psnr"], 25);
}

class OwnEditsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const TestBall ball{{0, 0, 0}, kSphereRadius};
    std::vector<TestView> views = test_views(ball, 6, kSize, kSize);
    write_nerf_split(capture(), "test", ball, {views[4], views[5]});
    views.resize(4);
    write_nerf_split(capture(), "train", ball, views);
  }
  fs::path capture() const { return temp_.path() / "capture"; }
  void write(const char* file, const char* text) { write_file_atomic(capture() / "edits" / file, text); }
  TempFolder temp_;
};

TEST_F(OwnEditsTest, AreReadFromBesideThePhotographs) {
  EXPECT_FALSE(own_edits(capture()).paint || own_edits(capture()).part);
  write("paint/view.json", R"({"view": "./train/r_002", "note": "more"})");
  write("part/prompts.json",
        R"({"view": "train/r_001", "positive": [[10, 20]], "target_color_srgb": "#102030"})");
  write("part/gt/r_004.png", "");
  write("part/mask/test/r_004.png", "");
  const OwnEdits own = own_edits(capture());
  EXPECT_EQ(own.paint->view, "./train/r_002");
  EXPECT_TRUE(own.paint_truth.pictures.empty());
  EXPECT_EQ(own.part->command.positive[0].x, 10.5);
  EXPECT_EQ(own.part->command.effects.color, "#102030");
  EXPECT_EQ(own.part->truth.masks, capture() / "edits/part/mask/test");
  write("part/prompts.json", R"({"view": "train/r_001", "positive": [10, 20]})");
  EXPECT_THAT(error_of([&] { own_edits(capture()); }).what(), HasSubstr("[x, y]"));
  write("part/prompts.json", "[]");
  EXPECT_THAT(error_of([&] { own_edits(capture()); }).what(), HasSubstr("\"view\""));
}

TEST_F(OwnEditsTest, AMadeScribbleLiesOnTheObject) {
  const Capture loaded = load_capture(capture());
  const PaintStroke stroke = made_scribble(loaded, temp_.path() / "scribble.png");
  const Image scribble = read_image(stroke.scribble.path),
              photo = read_image(find_view(loaded, stroke.view).image_path);
  int painted = 0, object = 0;
  for (size_t i = 3; i < scribble.data.size(); i += 4) {
    painted += scribble.data[i] > 0;
    object += photo.data[i] > 0.5f;
    if (scribble.data[i] > 0) {
      EXPECT_GT(photo.data[i], 0.5f);
    }
  }
  EXPECT_NEAR(double(painted) / object, 1.0 / 16, 0.02);
}

// One capture with an object that is given, and boards of its edits.
TEST_F(OwnEditsTest, BoardsShowTheMethodsInAnOrderThatTheKeyTells) {
  Project::create(temp_.path() / "object", {}, load_capture(capture()), false)
      .save_base(sphere_with_handlers());
  EvaluationSetRequest set;
  set.captures = {capture()};
  set.each.project = temp_.path() / "object";
  set.each.out = temp_.path() / "out";
  set.each.samples = 1;
  set.each.applications = true;
  set.boards = true;
  Session session("cpu");
  Progress quiet;
  const EvaluationSetReport report = evaluate_captures(session, set, quiet);
  ASSERT_EQ(report.captures.size(), 1u);
  const EvaluationReport& own = report.captures[0].reports.at(0);
  ASSERT_EQ(own.applications.size(), 3u);
  for (const EvaluationRow& r : own.applications) EXPECT_EQ(r.skipped, "");
  EXPECT_EQ(read_file(set.each.out / "report.md"), report.markdown());
  const Json key = Json::parse(read_file(set.each.out / "boards/key.json"));
  EXPECT_EQ(key.size(), 2u);
  for (const auto& [board, rows] : key.items()) {
    const Image picture = read_image(set.each.out / "boards" / (board + ".png"));
    ASSERT_EQ(picture.width, kSize * int(rows.size()));
    const std::string view = board.substr(board.find('-') + 1);
    for (size_t k = 0; k < rows.size(); ++k) {
      const Image row =
          read_image(set.each.out / "capture/pictures" / rows[k].get<std::string>() / (view + ".png"));
      for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
          ASSERT_TRUE(std::equal(picture.at(int(k) * kSize + x, y), picture.at(int(k) * kSize + x, y) + 3,
                                 row.at(2 * kSize + x, y)));
    }
  }
}

}  // namespace
}  // namespace cei3d
