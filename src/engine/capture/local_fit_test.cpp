// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/local_fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/math/fibonacci.h"

namespace cei3d {
namespace {

TEST(AgainstNearby, TellsWrongValuesFromAGradient) {
  std::vector<Vec3d> directions;
  std::vector<double> values;
  for (int i = 0; i < 60; ++i) {
    directions.push_back(normalize(to_double(fibonacci_direction(i, 60))));
    values.push_back(0.3 + 0.5 * directions.back().x - 0.4 * directions.back().z);
  }
  // The prior on slopes makes a small error of the gradient.
  for (const double off : against_nearby(directions, values)) EXPECT_NEAR(off, 0, 0.06);
  values[7] -= 0.8, values[30] += 0.5;
  const std::vector<double> off = against_nearby(directions, values);
  for (size_t i = 0; i < off.size(); ++i) {
    const double truth = i == 7 ? -0.8 : i == 30 ? 0.5 : 0;
    // The fit itself has a variance, which can only make a difference count less.
    EXPECT_NEAR(off[i], truth, 0.1 + 0.2 * std::abs(truth)) << i;
  }
}

TEST(AgainstNearby, SaysNothingOfFewValues) {
  const std::vector<Vec3d> directions{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_EQ(against_nearby(directions, std::vector<double>{1, 2, 9}), (std::vector<double>{0, 0, 0}));
}

}  // namespace
}  // namespace cei3d
