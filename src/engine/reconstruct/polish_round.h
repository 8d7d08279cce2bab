// SPDX-License-Identifier: Apache-2.0
// A round of polishing: light and material of the present surface are estimated, then the surface improves
// under them (appearance/surface_polish.h).
#pragma once

#include "engine/reconstruct/stage.h"

namespace cei3d {

// Skipped if there is no time. round: from 0 on.
void polish(const RunContext&, RunState&, int round, const Stage::Checkpoint&);

}  // namespace cei3d
