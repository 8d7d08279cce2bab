// SPDX-License-Identifier: Apache-2.0
// Json, the type of all JSON values, whole; json_fwd.h only declares it.
#pragma once

#include <nlohmann/json.hpp>

#include "core/base/json_fwd.h"
