// SPDX-License-Identifier: Apache-2.0
// How different two names are, for "did you mean ...".
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace cei3d {

// The number of letters to insert, remove or replace that makes one of the other. [Levenshtein 1966]
size_t name_distance(std::string_view a, std::string_view b);

// The first of those that are least different from `name`; empty when there are none.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

}  // namespace cei3d
