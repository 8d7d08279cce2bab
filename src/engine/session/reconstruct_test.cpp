// SPDX-License-Identifier: Apache-2.0
// Interrupted after its geometry is trained, a reconstruction leaves no half-made object and can go on.
#include <gtest/gtest.h>

#include <atomic>

#include "core/base/error.h"
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

 private:
  void on_report(const ProgressReport& r) override {
    if (r.stage == stage_) reached_ = true;
  }
  bool is_cancelled() const override { return reached_; }

  std::string stage_;
  std::atomic<bool> reached_ = false;
};

TEST(Reconstruct, InterruptedInALateStageIsGoneOnWith) {
  const TempFolder temp;
  const TestBall ball;
  write_nerf_split(temp.path() / "capture", "train", ball, test_views(ball, 6));
  ReconstructRequest request;
  request.capture = temp.path() / "capture";
  request.project = temp.path() / "object";
  request.options.iterations = 40;
  request.options.seconds = 10;  // beside iterations: light and material in brief
  request.options.test_every = 0;
  for (const char* stage : {"residual"}) {
    StopsAt stop(stage);
    try {
      Session().reconstruct(request, stop);
      ADD_FAILURE() << "not stopped at " << stage;
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::interrupted) << stage << ": " << e.what();
    }
    EXPECT_FALSE(Project::open(request.project, Project::Mode::read).has_base()) << stage;
    request.resume = true;
  }
  Progress quiet;
  EXPECT_GT(Session().reconstruct(request, quiet).vertices, 100u);
}

}  // namespace
}  // namespace cei3d
