// SPDX-License-Identifier: Apache-2.0
// The description that a synthetic capture carries.
#pragma once

#include "core/base/json.h"
#include "engine/synthetic/synthetic_capture.h"

namespace cei3d {

// meta.json: what was drawn and how to read the files. relight: names of the other lights.
Json capture_meta(const SynthRequest&, const SyntheticScene&, const std::vector<std::string>& relight);

}  // namespace cei3d
