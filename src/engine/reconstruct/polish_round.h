// SPDX-License-Identifier: Apache-2.0
// A round of polishing: light and material of the present surface are estimated, then the surface improves
// under them (appearance/surface_polish.h).
#pragma once

#include "engine/reconstruct/stage.h"

namespace cei3d {

// Seconds of a round's descent. left: for it and all rounds after it, each of which begins with an estimate
// of `look` seconds. Rounds whose descent would have less than `least` are left out, the last ones first.
double descent_seconds(double left, int rounds, double look, double least);

// Skipped if there is no time. round: from 0 on.
void polish(const RunContext&, RunState&, int round, const Stage::Checkpoint&);

}  // namespace cei3d
