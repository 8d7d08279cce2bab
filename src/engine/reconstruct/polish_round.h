// SPDX-License-Identifier: Apache-2.0
// A round of polishing: light and material of the present surface are estimated, then the surface improves
// under them (appearance/surface_polish.h).
#pragma once

#include "engine/reconstruct/stage.h"

namespace cei3d {

// Minimum share of a descent's planned time; less is not worth another estimate of light and material.
inline constexpr double kMinPolishShare = 1.0 / 6;
// Seconds of a round's descent. left: for it and all rounds after it, each of which begins with an estimate
// of `look` seconds. planned: for each descent. Rounds that would get less than the minimum share of that are
// left out, the last ones first, and leave their time to the others.
double descent_seconds(double left, int rounds, double look, double planned);

// Seconds that polishing leaves the stages of light and appearance, which need more than planned where there
// are several materials or the light turns. brief_seconds: of the first brief estimate. left: of polishing.
double seconds_lent(const Plan&, double brief_seconds, double left);

// Skipped if there is no time. round: from 0 on.
void polish(const RunContext&, RunState&, int round, const Stage::Checkpoint&);

}  // namespace cei3d
