// SPDX-License-Identifier: Apache-2.0
// A project whose reconstruction was interrupted holds no half-made object, and resumes where it was.
#include <gtest/gtest.h>

#include <atomic>
#include <set>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/temp_folder.h"
#include "engine/capture/test_capture.h"
#include "engine/project/project.h"
#include "engine/session/session.h"

namespace cei3d {
namespace {

// Asked to stop once a stage begins.
class StopsAt : public Progress {
 public:
  explicit StopsAt(std::string stage) : stage_(std::move(stage)) {}
  std::set<std::string> finished;

 private:
  void on_report(const ProgressReport& r) override {
    if (r.stage == stage_) reached_ = true;
  }
  void on_log(const std::string& line) override {
    const Json j = Json::parse(line);
    if (j.contains("took")) finished.insert(j.at("stage").get<std::string>());
  }
  bool is_cancelled() const override { return reached_; }

  std::string stage_;
  std::atomic<bool> reached_ = false;
};

std::set<std::string> stages_until(const ReconstructRequest& request, const std::string& stage) {
  StopsAt stop(stage);
  try {
    Session().reconstruct(request, stop);
    ADD_FAILURE() << "not stopped at " << stage;
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::interrupted) << stage << ": " << e.what();
    EXPECT_NE(e.hint().find("resume"), std::string::npos) << e.hint();
  }
  EXPECT_FALSE(Project::open(request.project, Project::Mode::read).has_base()) << stage;
  return stop.finished;
}

TEST(Reconstruct, InterruptedProjectHasNoObjectAndResumes) {
  const TempFolder temp;
  const TestBall ball;
  write_nerf_split(temp.path() / "capture", "train", ball, test_views(ball, 6));
  ReconstructRequest request;
  request.capture = temp.path() / "capture";
  request.project = temp.path() / "object";
  request.options.iterations = 4;
  request.options.test_every = 0;
  EXPECT_EQ(stages_until(request, "geometry"), std::set<std::string>{"start"});
  request.resume = true;
  EXPECT_EQ(stages_until(request, "appearance"), (std::set<std::string>{"geometry", "surface", "light"}));
}

}  // namespace
}  // namespace cei3d
