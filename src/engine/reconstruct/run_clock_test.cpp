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

struct VirtualTime {
  double seconds = 100;
  Clock clock() {
    return [this] { return seconds; };
  }
};

TEST(RunClock, MapsAStagesFractionToItsPartOfTheRun) {
  VirtualTime time;
  Listener listener;
  RunClock clock(listener, time.clock(), 0);
  clock.enter("geometry", 0.2, 0.6);
  clock.report({"steps", 0.5, -1, "loss"});
  EXPECT_DOUBLE_EQ(listener.heard[0].fraction, 0.2);
  EXPECT_DOUBLE_EQ(listener.heard[1].fraction, 0.4);
  EXPECT_EQ(listener.heard[1].stage, "geometry");
  EXPECT_EQ(listener.heard[1].message, "steps, loss");
}

TEST(RunClock, NeverFallsBack) {
  VirtualTime time;
  for (const double seconds : {0.0, 1000.0}) {
    Listener listener;
    RunClock clock(listener, time.clock(), seconds);
    clock.enter("stage", 0, 1);
    for (const double fraction : {0.1, 0.8, 0.95, 0.7, 1.0}) clock.report({"", fraction, -1, ""});
    clock.enter("another", 0.5, 0.8);
    for (size_t i = 1; i < listener.heard.size(); ++i)
      EXPECT_GE(listener.heard[i].fraction, listener.heard[i - 1].fraction) << seconds;
    EXPECT_LT(listener.heard.back().fraction, 1);
  }
}

TEST(RunClock, ARunWithALimitIsAsFarAsItsClock) {
  VirtualTime time;
  Listener listener;
  RunClock clock(listener, time.clock(), 1000);
  clock.resume_at(400);
  clock.enter("stage", 0, 0.1);
  EXPECT_DOUBLE_EQ(listener.heard[0].fraction, 0.4);
  EXPECT_DOUBLE_EQ(listener.heard[0].seconds_left, 600);
  time.seconds += 1100;
  EXPECT_DOUBLE_EQ(clock.elapsed(), 1500);
  EXPECT_DOUBLE_EQ(clock.left(), -500);
  clock.report({"", 0.5, -1, ""});
  EXPECT_LT(listener.heard[1].fraction, 1);  // late, but not over
  EXPECT_LT(listener.heard[1].seconds_left, 0);
}

}  // namespace
}  // namespace cei3d
