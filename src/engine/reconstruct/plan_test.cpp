// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/plan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <vector>

#include "core/base/error.h"
#include "engine/reconstruct/test_rates.h"

namespace cei3d {
namespace {

Rates times(Rates r, double factor) {
  for (double* rate : {&r.sdf_step, &r.trial_step, &r.albedo_step, &r.mesh, &r.hit_traced, &r.hit_shaded})
    *rate *= factor;
  return r;
}

Plan plan_for(const char* name, double seconds, size_t pixels, double slowness, bool cut_off = false) {
  ReconstructOptions options;
  options.seconds = seconds;
  Preset preset = preset_by_name(name);
  fit_to_footprint(preset, 0.004);
  return plan_of(options, preset, {pixels, cut_off}, times(kTestRates, slowness));
}

double sum_of(const Plan& p) {
  return p.geometry + p.light_motion + p.polish_rounds * (p.polish + p.look) + p.appearance +
         p.refinements * p.refinement + p.joint + p.finer_mesh + p.residual + p.reserve;
}

TEST(Plan, SpendsNoMoreThanWasAskedFor) {
  for (const char* name : {"fast", "balanced", "paper"})
    for (const double seconds : {180.0, 300.0, 600.0, 900.0, 3600.0, 36000.0})
      for (const size_t pixels : {300000u, 3000000u, 13000000u})
        for (const double slowness : {0.1, 0.5, 1.0, 2.0}) {
          const Plan p = plan_for(name, seconds, pixels, slowness);
          EXPECT_LE(sum_of(p), seconds * (1 + 1e-9))
              << name << " " << seconds << " " << pixels << " " << slowness;
          EXPECT_GE(p.geometry + p.joint, 0.35 * seconds);
          EXPECT_EQ(p.finer_mesh > 0, p.has_finer_mesh);
        }
}

// Only work per second counts: twice the time on a machine of half the speed is the same plan.
TEST(Plan, DependsOnTheMachinesSpeedAlone) {
  for (const double seconds : {60.0, 300.0, 900.0}) {
    const Plan here = plan_for("fast", seconds, 10000000, 1),
               there = plan_for("fast", 3 * seconds, 10000000, 3);
    EXPECT_EQ(here.polish_rounds, there.polish_rounds);
    EXPECT_EQ(here.refinements, there.refinements);
    EXPECT_EQ(here.has_finer_mesh, there.has_finer_mesh);
    EXPECT_NEAR(here.trial_steps, there.trial_steps, 1);
    EXPECT_EQ(here.effort, there.effort);
    EXPECT_NEAR(double(here.residual_pixels), double(there.residual_pixels), 1);
    EXPECT_NEAR(3 * here.geometry, there.geometry, 1e-6 * there.geometry);
  }
}

TEST(Plan, AFasterMachineLeavesNothingOutThatASlowerOneDoes) {
  for (const double seconds : {30.0, 60.0, 180.0, 300.0, 900.0}) {
    const Plan slow = plan_for("fast", seconds, 13000000, 2),
               quick = plan_for("fast", seconds, 13000000, 0.5);
    const auto trial_steps = [](const Plan& p) { return (p.hull_alone ? 1 : 3) * p.trial_steps; };
    EXPECT_GE(trial_steps(quick), trial_steps(slow));
    EXPECT_GE(quick.polish_rounds, slow.polish_rounds);
    EXPECT_GE(quick.refinements, slow.refinements);
    EXPECT_GE(quick.has_finer_mesh, slow.has_finer_mesh);
    EXPECT_GE(quick.residual_pixels, slow.residual_pixels);
    EXPECT_GE(quick.effort, slow.effort);
  }
}

// A start is chosen by shorter trials where there is less time, before it is not chosen at all. Not always
// shorter ones on a slower machine: where a stage is left out, the others get more time.
TEST(Plan, ASlowerMachineTriesStartsMoreBriefly) {
  const int all = preset_by_name("fast").trial.steps;
  std::vector<int> steps;
  for (double slowness = 0.5; slowness < 40; slowness *= 1.05) {
    const Plan p = plan_for("fast", 600, 3000000, slowness);
    steps.push_back(p.hull_alone ? 0 : p.trial_steps);
  }
  EXPECT_EQ(steps.front(), all);
  EXPECT_EQ(steps.back(), 0);
  const auto none = std::find(steps.begin(), steps.end(), 0);
  for (auto s = steps.begin(); s != none; ++s) {
    EXPECT_GE(4 * *s, all);
    EXPECT_LE(*s, all);
  }
  EXPECT_LT(*std::prev(none), all / 2);
  EXPECT_GT(std::set<int>(steps.begin(), none).size(), 4u);
}

TEST(Plan, ObjectsThatAreCutOffGetNoShortTrials) {
  const int all = preset_by_name("fast").trial.steps;
  int shorter = 0, none = 0;
  for (double slowness = 0.5; slowness < 40; slowness *= 1.05) {
    const Plan whole = plan_for("fast", 600, 3000000, slowness);
    const int seen_whole = whole.hull_alone ? 0 : whole.trial_steps,
              cut_off = plan_for("fast", 600, 3000000, slowness, true).trial_steps;
    EXPECT_EQ(cut_off, 4 * seen_whole >= 3 * all ? seen_whole : 0);
    shorter += cut_off > 0 && cut_off < all;
    none += cut_off == 0 && seen_whole > 0;
  }
  EXPECT_GT(shorter, 0);
  EXPECT_GT(none, 0);
}

// Not where even stereo takes too much of the time, and no object that is seen whole.
TEST(Plan, ObjectsThatAreCutOffStartFromStereoWhereThereIsNoTimeForTrials) {
  int by_stereo = 0, by_hull = 0;
  for (double slowness = 0.5; slowness < 100; slowness *= 1.05) {
    const Plan p = plan_for("fast", 600, 3000000, slowness, true);
    EXPECT_EQ(plan_for("fast", 600, 3000000, slowness, false).start, Start::hull);
    if (p.trial_steps == 0) ++(p.start == Start::stereo ? by_stereo : by_hull);
  }
  EXPECT_GT(by_stereo, 5);
  EXPECT_GT(by_hull, 5);
  EXPECT_EQ(plan_for("fast", 600, 3000000, 100, true).start, Start::hull);
}

// On slower machines than three start shapes are tried on; not for an object that is cut off, and not where
// the poses are to stay.
TEST(Plan, CamerasAreRefinedWithTheHullAloneWhereThereIsNoTimeForAllTrials) {
  ReconstructOptions given;
  given.seconds = 600;
  given.refine_poses = false;
  const Preset preset = preset_by_name("fast");
  int alone = 0;
  for (double slowness = 0.5; slowness < 100; slowness *= 1.05) {
    const Plan p = plan_for("fast", 600, 3000000, slowness);
    alone += p.hull_alone;
    EXPECT_FALSE(plan_for("fast", 600, 3000000, slowness, true).hull_alone);
    EXPECT_FALSE(plan_of(given, preset, {3000000}, times(kTestRates, slowness)).hull_alone);
    if (!p.hull_alone) continue;
    EXPECT_GE(5 * p.trial_steps, 2 * preset.trial.steps);
    EXPECT_LE(p.trial_steps, preset.trial.steps);
  }
  EXPECT_GT(alone, 10);
  EXPECT_EQ(plan_for("fast", 600, 3000000, 100).trial_steps, 0);
}

TEST(PlannedPixels, AnObjectAtTheBorderOfItsPhotographsIsCutOff) {
  constexpr int kSize = 20;
  for (const int cut : {1, 3}) {  // of eight views
    PixelStore store;
    for (int v = 0; v < 8; ++v) {
      Camera camera;
      camera.width = camera.height = kSize;
      camera.fx = camera.fy = kSize;
      Image image(kSize, kSize, 4);
      const int first = v < cut ? 0 : 5;
      for (int y = first; y < 15; ++y)
        for (int x = 5; x < 15; ++x) image.at(x, y)[3] = 1;
      store.add_view(camera, image, 1);
    }
    const PlannedPixels pixels = planned_pixels(store);
    EXPECT_EQ(pixels.cut_off, cut == 3);
    EXPECT_EQ(pixels.count, store.pixels().size());
  }
}

TEST(Plan, PolishesNoSurfaceThatWasTrainedBriefly) {
  constexpr double kSteps = 4000, kStep = 13 * kTestRates.sdf_step;  // of the geometry stage, seconds
  int polished = 0, not_polished = 0;
  for (double seconds = 30; seconds < 1000; seconds *= 1.1) {
    const Plan p = plan_for("fast", seconds, 3000000, 1);
    ++(p.polish_rounds > 0 ? polished : not_polished);
    if (p.polish_rounds == 0) continue;
    EXPECT_GE(p.geometry, std::min(kSteps * kStep, 0.65 * seconds)) << seconds;
  }
  EXPECT_GT(polished, 0);
  EXPECT_GT(not_polished, 0);
}

TEST(Plan, HasTimeForTheMotionOfTheLightUnlessItIsGivenOrPolishingHasIt) {
  EXPECT_EQ(plan_for("fast", 600, 3000000, 1).light_motion, 0);
  ReconstructOptions options;
  options.seconds = 60;
  const Preset preset = preset_by_name("fast");
  const Plan searching = plan_of(options, preset, {3000000}, kTestRates);
  options.light = LightMotion::world;
  const Plan given = plan_of(options, preset, {3000000}, kTestRates);
  EXPECT_GT(searching.light_motion, 0);
  EXPECT_EQ(given.light_motion, 0);
  EXPECT_GT(given.geometry, searching.geometry);
}

TEST(Plan, ALateRunDescendsOnTheAppearanceAsLongAsThereIsTime) {
  const Plan p = plan_for("fast", 600, 3000000, 1);
  ASSERT_EQ(p.effort, Effort::full);
  ASSERT_GT(p.descent, 0);
  EXPECT_LT(p.descent, p.appearance);
  EXPECT_EQ(affordable_descent(p, p.descent + p.finer_mesh + p.residual + p.reserve), 1);
  EXPECT_EQ(affordable_descent(p, 0), affordable_descent(p, -100));
  EXPECT_GT(affordable_descent(p, -100), 0);
  for (double left = 0; left < 200; left += 5) {
    const double share = affordable_descent(p, left), after = left - share * p.descent;
    if (share == affordable_descent(p, 0)) continue;  // cannot be less
    EXPECT_TRUE(has_time_for_finer_mesh(p, after));
    EXPECT_LE(seconds_of_residual(p, after - p.finer_mesh), after - p.finer_mesh);
  }
  EXPECT_FALSE(has_time_for_finer_mesh(p, 0));
  const Plan brief = plan_for("fast", 60, 3000000, 1);
  ASSERT_EQ(brief.effort, Effort::brief);
  EXPECT_EQ(affordable_descent(brief, 0), 1);
}

TEST(Plan, ByStepsKnowsNoClock) {
  ReconstructOptions options;
  options.iterations = 2000;
  const Plan p = plan_of(options, preset_by_name("balanced"), {3000000}, {});
  EXPECT_EQ(p.iterations, 2000);
  EXPECT_EQ(sum_of(p), 0);
  EXPECT_EQ(affordable_descent(p, std::numeric_limits<double>::infinity()), 1);
  EXPECT_TRUE(has_time_for_finer_mesh(p, std::numeric_limits<double>::infinity()));
  EXPECT_EQ(p.polish_steps, 300);
  EXPECT_GT(p.residual_pixels, 0u);
}

// A refinement sees other pixels than the stage before it, if there are any.
TEST(Plan, SparesTimeForRefinementsOfManyPixelsOnly) {
  const size_t seen = preset_by_name("fast").max_hits;
  for (const double seconds : {60.0, 900.0}) {
    EXPECT_EQ(plan_for("fast", seconds, seen, 1).spare_refinements, 0);
    EXPECT_GT(plan_for("fast", seconds, 3 * seen, 1).spare_refinements, 0);
  }
  EXPECT_EQ(plan_of({}, preset_by_name("fast"), {3 * seen}, kTestRates).spare_refinements, 0);
}

TEST(Plan, OfACoupledColorHasNoLight) {
  Preset preset = preset_by_name("fast");
  preset.color = ColorChoice::coupled;
  fit_to_footprint(preset, 0.004);
  for (const double seconds : {0.0, 30.0, 180.0, 900.0}) {
    ReconstructOptions options;
    options.seconds = seconds;
    const Plan p = plan_of(options, preset, {3000000}, kTestRates);
    EXPECT_EQ(p.color, ColorChoice::coupled);
    EXPECT_EQ(p.polish_rounds + p.refinements + p.spare_refinements + p.joint_steps, 0);
    EXPECT_EQ(p.appearance, 0);
    EXPECT_EQ(p.residual_pixels, 0u);
    EXPECT_GT(p.residual_steps, 0);
    EXPECT_GT(p.residual_hits, 0u);
    EXPECT_NEAR(sum_of(p), seconds, 1e-9 * seconds);
    EXPECT_GE(p.geometry, 0.35 * seconds * (1 - 1e-9));
  }
  preset.stages = StageChoice::joint;
  EXPECT_THROW(plan_of({}, preset, {3000000}, kTestRates), Error);
}

TEST(Plan, OfTheJointDescentAloneGivesItTheTime) {
  const Plan p = plan_for("paper", 3600, 3000000, 1);
  EXPECT_EQ(p.stages, StageChoice::joint);
  EXPECT_GT(p.joint, 0.8 * 3600);
  EXPECT_EQ(p.joint_steps, 200000);
  EXPECT_EQ(p.geometry + p.polish_rounds + p.appearance + p.residual, 0);
  ReconstructOptions by_steps;
  EXPECT_EQ(plan_of(by_steps, preset_by_name("paper"), {3000000}, {}).joint, 0);
  by_steps.iterations = 25000;
  EXPECT_EQ(plan_of(by_steps, preset_by_name("paper"), {3000000}, {}).joint_steps, 25000);
}

}  // namespace
}  // namespace cei3d
