// SPDX-License-Identifier: Apache-2.0
// Fewer elements of a list.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace cei3d {

// Every n-th element, the first one included, with the smallest n that leaves at most max_count of them.
// max_count: at least 1.
template <class List>
std::vector<typename List::value_type> thinned(const List& list, size_t max_count) {
  const size_t step = std::max<size_t>((list.size() + max_count - 1) / max_count, 1);
  std::vector<typename List::value_type> kept;
  for (size_t i = 0; i < list.size(); i += step) kept.push_back(list[i]);
  return kept;
}

}  // namespace cei3d
