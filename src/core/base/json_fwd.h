// SPDX-License-Identifier: Apache-2.0
// For headers that only name Json: what makes, reads or holds one includes core/base/json.h.
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace cei3d {
using Json = nlohmann::ordered_json;
}
