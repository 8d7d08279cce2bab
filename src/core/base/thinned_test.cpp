// SPDX-License-Identifier: Apache-2.0
#include "core/base/thinned.h"

#include <gtest/gtest.h>

#include <numeric>
#include <span>

namespace cei3d {
namespace {

// By brute force: the smallest step that leaves no more than allowed.
TEST(Thinned, TakesEveryNthElementWithTheSmallestStepThatSuffices) {
  for (size_t size = 0; size < 30; ++size)
    for (size_t max_count = 1; max_count < 35; ++max_count) {
      std::vector<int> list(size);
      std::iota(list.begin(), list.end(), 0);
      const auto every = [&](size_t step) {
        std::vector<int> out;
        for (const int i : list)
          if (size_t(i) % step == 0) out.push_back(i);
        return out;
      };
      size_t step = 1;
      while (every(step).size() > max_count) ++step;
      EXPECT_EQ(thinned(list, max_count), every(step)) << size << " " << max_count;
      EXPECT_EQ(thinned(std::span<const int>(list), max_count), every(step));
    }
}

}  // namespace
}  // namespace cei3d
