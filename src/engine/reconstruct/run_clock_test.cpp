// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/run_clock.h"

#include <gtest/gtest.h>

#include <vector>

namespace cei3d {
namespace {

class Listener : public Progress {
 public:
  std::vector<ProgressReport> heard;

 private:
  void on_report(const ProgressReport& r) override { heard.push_back(r); }
};

TEST(RunClock, StagesThatComeTwiceNeverTurnItBack) {
  for (const double seconds : {0.0, 1000.0}) {
    Listener listener;
    RunClock clock(listener, seconds);
    for (const double fraction : {0.1, 0.8, 0.95, 0.7, 1.0}) clock.report({"stage", fraction, -1, ""});
    for (size_t i = 1; i < listener.heard.size(); ++i)
      EXPECT_GE(listener.heard[i].fraction, listener.heard[i - 1].fraction) << seconds;
    EXPECT_EQ(listener.heard.back().fraction, 1);
  }
}

TEST(RunClock, TellsByTheTimeGiven) {
  Listener listener;
  RunClock clock(listener, 1000);
  clock.resume_at(400);
  clock.report({"stage", 0.01, -1, ""});
  EXPECT_NEAR(listener.heard[0].fraction, 0.4, 0.1);
  EXPECT_NEAR(listener.heard[0].seconds_left, 600, 100);
  clock.resume_at(1500);
  EXPECT_LT(clock.left(), 0);
  clock.report({"stage", 0.01, -1, ""});
  EXPECT_LT(listener.heard[1].fraction, 1);  // late, but not over
}

}  // namespace
}  // namespace cei3d
