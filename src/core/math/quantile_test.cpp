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
    EXPECT_EQ(quantile(values, 0), sorted.front());
    EXPECT_EQ(quantile(values, 1), sorted.back());
  }
}

TEST(Quantile, OfAShareHasAsManyValuesBelowIt) {
  std::vector<int> values(101);
  for (int i = 0; i < 101; ++i) values[size_t(i)] = (37 * i) % 101;  // 0 to 100 in another order
  for (const double share : {0.01, 0.25, 0.5, 0.98}) EXPECT_NEAR(quantile(values, share), 100 * share, 1);
}

}  // namespace
}  // namespace cei3d
