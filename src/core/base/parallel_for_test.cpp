// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "core/base/parallel.h"

namespace cei3d {
namespace {

TEST(ParallelFor, RunsEveryChunkOnce) {
  for (const int chunks : {0, 1, 2, 3, 1000}) {
    std::vector<int> runs(size_t(chunks), 0);
    parallel_for(chunks, [&](int i) { ++runs[size_t(i)]; });
    EXPECT_EQ(runs, std::vector<int>(size_t(chunks), 1));
  }
}

TEST(ParallelFor, WhatWasWrittenBeforeAndInsideIsSeenInsideAndAfter) {
  for (int round = 0; round < 100; ++round) {
    std::vector<int> in(64), out(64);
    std::iota(in.begin(), in.end(), round);
    parallel_for(64, [&](int i) { out[size_t(i)] = 2 * in[size_t(i)]; });
    for (int i = 0; i < 64; ++i) ASSERT_EQ(out[size_t(i)], 2 * (i + round));
  }
}

TEST(ParallelFor, MayBeCalledFromWithin) {
  std::atomic<int> runs = 0;
  parallel_for(7, [&](int) { parallel_for(11, [&](int) { ++runs; }); });
  EXPECT_EQ(runs, 77);
}

TEST(ParallelFor, AnExceptionReachesTheCallerAndTheNextCallWorks) {
  EXPECT_THROW(parallel_for(50,
                            [](int i) {
                              if (i == 31) throw std::runtime_error("chunk 31");
                            }),
               std::runtime_error);
  std::atomic<int> runs = 0;
  parallel_for(5, [&](int) { ++runs; });
  EXPECT_EQ(runs, 5);
}

TEST(ParallelRanges, CoverAllItemsWithRangesOfTheGrain) {
  for (const int n : {0, 1, 99, 100, 101}) {
    std::vector<int> items(size_t(n), 0);
    parallel_ranges(n, 10, [&](int begin, int end) {
      EXPECT_EQ(begin % 10, 0);
      EXPECT_TRUE(end == n || end == begin + 10);
      for (int i = begin; i < end; ++i) ++items[size_t(i)];
    });
    EXPECT_EQ(items, std::vector<int>(size_t(n), 1));
  }
}

}  // namespace
}  // namespace cei3d
