// SPDX-License-Identifier: Apache-2.0
#include "core/base/name_distance.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace cei3d {

size_t name_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t(0));
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = std::exchange(row[0], i);
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t change = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
    }
  }
  return row.back();
}

std::string nearest_name(std::string_view name, std::span<const std::string> known) {
  const auto it =
      std::min_element(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
        return name_distance(name, a) < name_distance(name, b);
      });
  return it == known.end() ? std::string() : *it;
}

}  // namespace cei3d
