// SPDX-License-Identifier: Apache-2.0
// Medians and other ranks of values.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace cei3d {

// The value that stands at index `rank` when the values are sorted, the smallest first. rank < values.size().
template <class T>
T value_of_rank(std::vector<T> values, size_t rank) {
  const auto at = values.begin() + std::ptrdiff_t(rank);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

// The middle value; of an even number of values the larger of the two in the middle. values: not empty.
template <class T>
T median(std::vector<T> values) {
  const size_t middle = values.size() / 2;
  return value_of_rank(std::move(values), middle);
}

// The value than which about this share of the values is smaller: that of rank share (n - 1), rounded down.
// share: [0, 1]. values: not empty.
template <class T>
T quantile(std::vector<T> values, double share) {
  const auto rank = size_t(share * double(values.size() - 1));
  return value_of_rank(std::move(values), rank);
}

}  // namespace cei3d
