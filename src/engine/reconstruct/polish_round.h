// SPDX-License-Identifier: Apache-2.0
// A round of polishing: light and material of the present surface are estimated, then the surface improves
// under them (appearance/surface_polish.h).
#pragma once

#include "engine/reconstruct/stage.h"

namespace cei3d {

// Whether a descent of so many seconds is worth another estimate of light and material: it is as long as
// planned, or at least as long as the estimate, which takes `look` seconds.
bool worth_a_look(double seconds, double look, double planned);
// Seconds of a round's descent, at most as many as planned. left: for it and all rounds after it, each of
// which begins with an estimate of `look` seconds. Rounds that are not worth their look are left out, the
// last ones first; what the others do not need of their time is left to later stages.
double descent_seconds(double left, int rounds, double look, double planned);

// Seconds that polishing leaves the stages of light and appearance, which need more than planned where there
// are several materials or the light turns. brief_seconds: of the first brief estimate. left: of polishing.
double seconds_lent(const Plan&, double brief_seconds, double left);

// Skipped if there is no time. round: from 0 on.
void polish(const RunContext&, RunState&, int round, const Stage::Checkpoint&);

}  // namespace cei3d
