// SPDX-License-Identifier: Apache-2.0
// The schedule of the geometry stage: by steps or by the clock, with reports and checkpoints on the way.
#pragma once

#include "engine/reconstruct/stage.h"

namespace cei3d {

// Stores poses and focal length of the training cameras in the scene, and takes all cameras from there again:
// what is stored is rounded, and a resumed run must have the same cameras.
void keep_cameras(const RunContext&, RunState& state);
// Stores the exposures of the training pixels in the scene.
void keep_exposures(const RunContext&, RunState&);

// Trains state.geometry from state.step to the end of the schedule.
void train_geometry(const RunContext&, RunState& state, const Stage::Checkpoint& checkpoint);

// Logs the PSNR of the radiance field on held-out views, for comparison with shading by light and material.
// Up to 8 views, as many as 15 s allow, in a run with a time limit a quarter of its reserve. Stops when
// progress.cancelled(). focal: factor on the focal lengths of the capture.
void log_radiance_psnr(const RunContext&, GeometryStage&, double focal);

}  // namespace cei3d
