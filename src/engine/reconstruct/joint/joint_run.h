// SPDX-License-Identifier: Apache-2.0
// A reconstruction by the joint descent alone: from start values, of which the photographs say nothing, to
// the object. No start shape, no separation of light and albedo, no polishing. [paper sec. 4.4]
#pragma once

#include "engine/reconstruct/stage.h"

namespace cei3d {

// make_finer_mesh: run where the plan has a finer mesh.
std::vector<Stage> joint_stages(const Plan&, const Stage::Run& make_finer_mesh);

}  // namespace cei3d
