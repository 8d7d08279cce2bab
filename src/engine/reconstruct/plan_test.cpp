// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/plan.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

TEST(Plan, SpendsNoMoreThanWasAskedFor) {
  for (const char* name : {"fast", "balanced", "paper"})
    for (const double seconds : {180.0, 300.0, 600.0, 900.0, 3600.0, 36000.0})
      for (const size_t pixels : {300000u, 3000000u, 13000000u}) {
        ReconstructOptions options;
        options.seconds = seconds;
        Preset preset = preset_by_name(name);
        fit_to_footprint(preset, 0.004);
        const Plan p = plan_of(options, preset, pixels);
        const double sum = p.geometry + p.rounds * (p.polish + p.between) + p.appearance +
                           p.refinements * p.refinement + p.finishing + p.residual + p.saving;
        EXPECT_EQ(p.finish, seconds >= 300 && preset.resolution_from_views);  // "paper" has one mesh
        EXPECT_EQ(p.finishing > 0, p.finish);
        EXPECT_LE(sum, seconds) << name << " " << pixels;
        EXPECT_GE(p.geometry, 0.35 * seconds) << name << " " << pixels;
      }
}

TEST(Plan, ByStepsKnowsNoClock) {
  ReconstructOptions options;
  options.iterations = 2000;
  const Plan p = plan_of(options, preset_by_name("paper"), 3000000);
  EXPECT_EQ(p.iterations, 2000);
  EXPECT_EQ(p.geometry + p.polish + p.appearance + p.residual, 0);
}

}  // namespace
}  // namespace cei3d
