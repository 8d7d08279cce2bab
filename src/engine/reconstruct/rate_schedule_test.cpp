// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/rate_schedule.h"

#include <gtest/gtest.h>

#include "engine/reconstruct/geometry/geometry_options.h"

namespace cei3d {
namespace {

// 5e-4, halved every 25,000 of 200,000 steps, as the paper has it: a table by hand.
TEST(RateSchedule, HalvesAfterEachPart) {
  constexpr double kRate = 5e-4;
  constexpr std::pair<int, double> kTable[] = {
      {0, 5e-4},        {24999, 5e-4},      {25000, 2.5e-4},      {49999, 2.5e-4},
      {50000, 1.25e-4}, {100000, 3.125e-5}, {175000, 3.90625e-6}, {199999, 3.90625e-6}};
  const RateSchedule paper{.warm_up = 0, .halving_parts = 8};
  GeometryOptions geometry;
  geometry.halving_parts = 8;
  for (const auto& [step, rate] : kTable) {
    const double u = step / 200000.0;
    EXPECT_DOUBLE_EQ(kRate * rate_at(paper, u, 200000), rate) << step;
    if (u > 0.02) {  // it rises before
      EXPECT_FLOAT_EQ(float(kRate) * rate_at(geometry, u), float(rate)) << step;
    }
  }
}

TEST(RateSchedule, RisesAndThenFallsToTheLastRate) {
  const RateSchedule s{.warm_up = 0.1, .last = 0.2};
  EXPECT_NEAR(rate_at(s, 0, 1000), 0.01, 1e-12);  // one of a hundred steps that it rises for
  EXPECT_NEAR(rate_at(s, 0.5, 1000), std::sqrt(0.2), 1e-12);
  EXPECT_NEAR(rate_at(s, 0.999999, 1000), 0.2, 1e-5);
}

}  // namespace
}  // namespace cei3d
