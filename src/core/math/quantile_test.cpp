// SPDX-License-Identifier: Apache-2.0
#include "core/math/quantile.h"

#include <gtest/gtest.h>

#include "core/math/rng.h"

namespace cei3d {
namespace {

TEST(Quantile, EveryRankIsThatOfTheSortedValues) {
  for (const size_t n : {1u, 2u, 7u, 100u}) {
    std::vector<float> values(n);
    for (size_t i = 0; i < n; ++i) values[i] = float(Rng(3, n, i).below(40));
    std::vector<float> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    for (size_t rank = 0; rank < n; ++rank) EXPECT_EQ(value_of_rank(values, rank), sorted[rank]);
    EXPECT_EQ(median(values), sorted[n / 2]);
  }
}

}  // namespace
}  // namespace cei3d
