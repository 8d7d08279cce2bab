// SPDX-License-Identifier: Apache-2.0
// The stages of a reconstruction, from the start shape to the correction.
#pragma once

#include "engine/reconstruct/stage.h"

namespace cei3d {

std::vector<Stage> stages_of(const Plan&);

}  // namespace cei3d
