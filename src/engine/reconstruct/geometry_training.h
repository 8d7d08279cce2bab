// SPDX-License-Identifier: Apache-2.0
// The schedule of the geometry stage: by steps or by the clock, with reports and checkpoints on the way.
#pragma once

#include "engine/reconstruct/stage.h"

namespace cei3d {

// Stores the poses of the training cameras in the scene, and takes the cameras from there again: stored poses
// are rounded, and a resumed run must have the same cameras.
void keep_poses(const RunContext&, RunState& state);
// Stores the exposures of the training pixels in the scene.
void keep_exposures(const RunContext&, RunState&);

// Trains state.geometry from state.step to the end of the schedule.
void train_geometry(const RunContext&, RunState& state, const Stage::Checkpoint& checkpoint);

// Logs the PSNR of the radiance field on held-out views, for comparison with shading by light and material.
// Up to 8 views, as many as 15 s allow, in a run with a time limit a quarter of its reserve. Stops when
// progress.cancelled().
void log_radiance_psnr(const RunContext&, GeometryStage&);

}  // namespace cei3d
