// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/rates.h"

#include <gtest/gtest.h>

#include "engine/reconstruct/test_run.h"
#include "engine/reconstruct/training_views.h"

namespace cei3d {
namespace {

// On a clock that ticks once a look, every piece of work takes one tick.
TEST(Rates, AreTheTicksOfAPieceOfWorkOverItsSize) {
  const BoxCapture capture;
  Progress quiet;
  const TrainingViews views = load_training_views(capture.capture(), capture, {}, quiet);
  VirtualClock time(2.0);
  const Preset preset = shrunken(preset_by_name("fast"));
  const Rates r = measure_rates(make_device(), preset, views.train, time.clock(), quiet);
  EXPECT_EQ(r.sdf_step, 2);
  EXPECT_EQ(r.trial_step, 2);
  EXPECT_EQ(r.albedo_step, 2);
  EXPECT_EQ(r.mesh, 2.0 / (16 * 16));
  EXPECT_GT(r.hit_traced, 0);
  EXPECT_LT(r.hit_traced, 2);
  EXPECT_EQ(r.hit_traced, r.hit_shaded);
  EXPECT_EQ(to_json(rates_from_json(to_json(r))), to_json(r));
}

// Steps that take ten times as long before caches are warm.
TEST(Rates, DoNotDependOnTheFirstSteps) {
  const BoxCapture capture;
  Progress quiet;
  const TrainingViews views = load_training_views(capture.capture(), capture, {}, quiet);
  double seconds = 0;
  int looks = 0;
  const Clock clock = [&] { return seconds += looks++ < 10 ? 1e-2 : 1e-3; };
  const Preset preset = shrunken(preset_by_name("fast"));
  EXPECT_NEAR(measure_rates(make_device(), preset, views.train, clock, quiet).sdf_step, 1e-3, 1e-9);
}

}  // namespace
}  // namespace cei3d
