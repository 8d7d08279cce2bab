// SPDX-License-Identifier: Apache-2.0
// JSON from files and requests, which others may have written.
#pragma once

#include <string_view>

#include "core/base/json.h"

namespace cei3d {

// Of arrays and objects in each other. Nothing that is read goes deeper than 10; copying and writing a value
// takes as many calls in each other as it is deep.
inline constexpr int kMaxJsonDepth = 64;
bool nested_too_deep(std::string_view text);

// The value of a text; is_discarded() where it is not JSON or nested too deep.
Json parse_json(std::string_view text);

}  // namespace cei3d
