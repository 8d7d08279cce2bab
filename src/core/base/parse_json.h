// SPDX-License-Identifier: Apache-2.0
// JSON from files and requests, which others may have written.
#pragma once

#include <string_view>

#include "core/base/json.h"

namespace cei3d {

// The most levels of arrays and objects in each other. What the program reads has at most 10; copying and
// writing a value calls itself once for each level, which must not exhaust the stack.
inline constexpr int kMaxJsonDepth = 64;
bool nested_too_deep(std::string_view text);

// The value of a text; is_discarded() where it is not JSON or nested too deep.
Json parse_json(std::string_view text);

}  // namespace cei3d
