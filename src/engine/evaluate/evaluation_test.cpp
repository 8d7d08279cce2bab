// SPDX-License-Identifier: Apache-2.0
// The evaluation of a sphere: its rows are what the same calls of a Session give, and what is finished stays.
#include "engine/evaluate/evaluation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/capture/capture.h"
#include "engine/capture/test_capture.h"
#include "engine/io/image_file.h"
#include "engine/project/project.h"
#include "engine/render/sphere_scene.h"

namespace cei3d {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr int kSize = 48;

// Asked to stop after so many reports.
class Impatient : public Progress {
 public:
  explicit Impatient(int patience) : patience_(patience) {}

 private:
  void on_report(const ProgressReport&) override { --patience_; }
  bool is_cancelled() const override { return patience_ < 0; }

  std::atomic<int> patience_;
};

class EvaluationTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const TestBall ball{{0, 0, 0}, kSphereRadius};
    std::vector<TestView> views = test_views(ball, 6, kSize, kSize);
    write_nerf_split(folder("capture"), "test", ball, {views[4], views[5]});
    views.resize(4);
    write_nerf_split(folder("capture"), "train", ball, views);
    Project::create(folder("object"), {}, load_capture(folder("capture")), false)
        .save_base(sphere_with_handlers());
    write_scribble(0.9f);
  }
  fs::path folder(const std::string& name) const { return temp_.path() / name; }
  void write_scribble(float red) {
    Image s(kSize, kSize, 4);
    for (int y = 18; y < 30; ++y)
      for (int x = 18; x < 30; ++x) s.at(x, y)[0] = red, s.at(x, y)[3] = 1;
    write_png(folder("scribble.png"), s);
  }
  EvaluationRequest request() const {
    EvaluationRequest r;
    r.capture = folder("capture");
    r.project = folder("object");
    r.out = folder("out");
    r.samples = 1;
    r.paint = PaintStroke{"train/r_000", folder("scribble.png")};
    return r;
  }
  EvaluationReport run(const EvaluationRequest& r) {
    Session session("cpu");
    Progress quiet;
    return evaluate_capture(session, r, quiet);
  }
  TempFolder temp_;
};

TEST_F(EvaluationTest, RowsAreWhatTheSameCallsGive) {
  EvaluationRequest r = request();
  r.part = PartTrial{};
  r.part->command.view = "train/r_000";
  r.part->command.positive = {{24, 16}};
  r.part->command.negative = {{24, 36}};
  r.part->command.effects.color = "#20a040";
  r.views = {100};
  const EvaluationReport report = run(r);

  Session session("cpu");
  Progress quiet;
  fs::copy(folder("object"), folder("copy"), fs::copy_options::recursive);
  session.open(folder("copy"), Session::Access::write);
  EvalRequest plain;
  plain.samples = 1;
  EXPECT_EQ(report.object.scores.json(), session.evaluate(plain, quiet).json());
  ASSERT_EQ(report.paint.size(), 5u);
  PaintCommand command;
  command.strokes = {*r.paint};
  command.routing = Routing::none;
  EvalRequest with_edit = plain;
  with_edit.edit = session.paint(command, quiet).id;
  EXPECT_EQ(report.paint[3].name, "paint-none");
  EXPECT_EQ(report.paint[3].scores.json(), session.evaluate(with_edit, quiet).json());
  ASSERT_EQ(report.part.size(), 2u);
  EXPECT_EQ(report.part[1].name, "part-in-view");
  EXPECT_TRUE(report.part[1].scores.edit->rest);

  ASSERT_EQ(report.views.size(), 1u);
  EXPECT_THAT(report.views[0].skipped, HasSubstr("4 training views"));
  const std::string text = read_file(folder("out/report.md"));
  EXPECT_EQ(text, report.markdown());
  EXPECT_THAT(text, HasSubstr("Skipped, 100 views"));
  EXPECT_EQ(Json::parse(read_file(folder("out/report.json"))), report.json());
  EXPECT_EQ(read_image(folder("out/pictures/paint/r_004.png")).width, 3 * kSize);
  session.open(folder("object"), Session::Access::read);
  EXPECT_TRUE(session.log().empty());  // the object that was given is left alone
  EXPECT_THAT(text, HasSubstr(session.info().object.text()));
}

TEST_F(EvaluationTest, WhatIsFinishedIsKeptAndWhatChangedIsNot) {
  EvaluationRequest r = request();
  r.ablations = false;
  const EvaluationReport first = run(r);
  EXPECT_EQ(run(r).json(), first.json());  // to the last digit of the seconds: nothing was made again
  write_scribble(0.2f);
  const EvaluationReport other = run(r);
  EXPECT_EQ(other.object.json(), first.object.json());
  EXPECT_NE(other.paint[0].scores.json(), first.paint[0].scores.json());
  write_file_atomic(folder("out/rows/object.json"), "damaged");
  EXPECT_EQ(run(r).object.scores.json(), first.object.scores.json());
}

TEST_F(EvaluationTest, GoesOnWhereItWasInterrupted) {
  EvaluationRequest r = request();
  const EvaluationReport whole = run(r);
  r.out = folder("again");
  int interruptions = 0;
  for (int patience = 3;; patience += 5) {
    Session session("cpu");
    Impatient impatient(patience);
    try {
      const EvaluationReport report = evaluate_capture(session, r, impatient);
      ASSERT_EQ(report.paint.size(), whole.paint.size());
      for (size_t i = 0; i < whole.paint.size(); ++i)
        EXPECT_EQ(report.paint[i].scores.json(), whole.paint[i].scores.json());
      break;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::interrupted) << e.what();
      ++interruptions;
    }
  }
  EXPECT_GT(interruptions, 2);
}

TEST_F(EvaluationTest, SaysWhatIsWrong) {
  EvaluationRequest r = request();
  r.paint->view = "r_077";
  EXPECT_THROW(run(r), Error);
  r = request();
  write_nerf_split(folder("other"), "train", {}, test_views({}, 3, kSize, kSize));
  r.capture = folder("other");
  EXPECT_THROW(run(r), Error);  // the object is of another capture
  EXPECT_FALSE(fs::exists(folder("out")));
}

}  // namespace
}  // namespace cei3d
