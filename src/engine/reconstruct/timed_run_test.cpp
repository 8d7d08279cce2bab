// SPDX-License-Identifier: Apache-2.0
// Runs with a time limit, on a clock that ticks with every look at it.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "core/base/json.h"
#include "engine/reconstruct/test_rates.h"
#include "engine/reconstruct/test_run.h"

namespace cei3d {
namespace {

class TimedRun {
 public:
  TimedRun(const BoxCapture& capture, const Preset& preset, double limit)
      : capture_(capture), preset_(preset), time_(0.001 * limit) {
    options_.seconds = limit;
  }
  void run(const Rates& rates = kTestRates) {
    scene = reconstruct({.device = device_,
                         .capture = capture_.capture(),
                         .images = capture_,
                         .normalization = {},
                         .options = options_,
                         .preset = preset_,
                         .clock = time_.clock(),
                         .rates = rates},
                        checkpoints, *progress);
  }
  bool has(const std::string& stage) const {
    return std::count(progress->stages.begin(), progress->stages.end(), stage) > 0;
  }
  double seconds() const { return time_.seconds(); }
  Json plan() const {
    for (const Json& line : progress->lines)
      if (line.at("stage") == "plan") return line.at("plan");
    return {};
  }

  MemoryCheckpoints checkpoints;
  std::unique_ptr<ScriptedProgress> progress = std::make_unique<ScriptedProgress>();
  Scene scene;

 private:
  Device device_ = make_device();
  const BoxCapture& capture_;
  Preset preset_;
  VirtualClock time_;
  ReconstructOptions options_;
};

Preset preset_for_time(const std::string& name) {
  Preset preset = shrunken(preset_by_name(name));
  preset.polish_steps = 600;  // so that the clock ends polishing
  return preset;
}

void expect_complete(const Scene& scene, const std::string& where) {
  EXPECT_TRUE(scene.sdf && scene.albedo && scene.handlers && scene.surface) << where;
  EXPECT_FALSE(scene.light.lobes.empty()) << where;
}

TEST(TimedRun, EveryPresetEndsInTimeWithTheStagesOfItsPlan) {
  const BoxCapture capture;
  const std::vector<std::pair<std::string, double>> runs{
      {"fast", 30}, {"fast", 400}, {"balanced", 100}, {"paper", 400}};
  for (const auto& [name, limit] : runs) {
    const std::string where = name + " " + std::to_string(limit);
    TimedRun r(capture, preset_for_time(name), limit);
    r.run();
    EXPECT_LE(r.seconds(), limit) << where;
    EXPECT_GE(r.seconds(), 0.5 * limit) << where;
    const bool ours = name != "paper";
    EXPECT_EQ(r.has("geometry"), ours) << where;
    EXPECT_TRUE(ours || r.has("joint")) << where;
    EXPECT_EQ(r.has("polish 1"), ours && limit >= 100) << where;
    EXPECT_EQ(r.has("polish 2"), ours && limit >= 400) << where;
    EXPECT_EQ(r.has("residual"), ours) << where;
    EXPECT_EQ(r.has("finer mesh"), ours) << where;
    expect_complete(r.scene, where);
    const std::vector<double>& fractions = r.progress->fractions;
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end())) << where;
    EXPECT_EQ(fractions.back(), 1) << where;
  }
}

TEST(TimedRun, RefinesTheAlbedoOfManyPixelsAndIsResumedThere) {
  const BoxCapture capture(24, 32);
  Preset preset = preset_for_time("fast");
  preset.max_hits = 1500;
  TimedRun r(capture, preset, 400);
  r.run();
  ASSERT_TRUE(r.has("albedo 1"));
  EXPECT_LE(r.seconds(), 1.05 * 400);  // a tick is long
  expect_complete(r.scene, "with refinements");

  const std::vector<std::string>& stages = r.progress->stages;
  const auto at = std::find(stages.begin(), stages.end(), "albedo 1");
  const int checks = r.progress->checks.at("albedo 1");
  for (const auto how : {ScriptedProgress::How::cancel, ScriptedProgress::How::kill}) {
    TimedRun again(capture, preset, 400);
    again.checkpoints.latest_state = r.checkpoints.after.at(*(at - 1));
    again.progress->stop_at("albedo 1", checks / 2, how);
    EXPECT_ANY_THROW(again.run());
    again.progress = std::make_unique<ScriptedProgress>();
    again.progress->stop_at(*(at + 1), 1);
    EXPECT_THROW(again.run(), Error);
    expect_same(again.checkpoints.after.at("albedo 1").tensors, r.checkpoints.after.at("albedo 1").tensors,
                "after the refinement");
  }
}

TEST(TimedRun, ResumedKeepsItsPlanAndItsTime) {
  const BoxCapture capture;
  TimedRun r(capture, preset_for_time("fast"), 400);
  r.progress->stop_at("polish 2", 5);
  EXPECT_THROW(r.run(), Error);
  const Json plan = r.plan();
  r.progress = std::make_unique<ScriptedProgress>();
  Rates slower = kTestRates;
  slower.albedo_step *= 10;
  r.run(slower);  // not read: the checkpoint has those of the first part
  EXPECT_EQ(r.plan(), plan);
  EXPECT_FALSE(r.has("polish 1"));
  EXPECT_TRUE(r.has("polish 2"));
  EXPECT_LE(r.seconds(), 1.15 * 400);  // the interrupted round was begun anew
  expect_complete(r.scene, "resumed");
}

}  // namespace
}  // namespace cei3d
