// SPDX-License-Identifier: Apache-2.0
#include "core/math/parabola.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

TEST(Parabola, FindsTheVertex) {
  for (const double vertex : {-0.5, -0.2, 0.0, 0.31, 0.5}) {
    const auto f = [&](double x) { return 3 + 0.7 * (x - vertex) * (x - vertex); };
    EXPECT_NEAR(lowest_offset(f(-1), f(0), f(1)), vertex, 1e-12);
    const double last = last_offset_within(f(-1), f(0), f(1), 0.1);
    EXPECT_NEAR(f(last), 3.1, 1e-12);
    EXPECT_GT(last, vertex);
  }
  EXPECT_EQ(lowest_offset(2, 2, 2), 0);
}

}  // namespace
}  // namespace cei3d
