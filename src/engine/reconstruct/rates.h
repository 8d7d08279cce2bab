// SPDX-License-Identifier: Apache-2.0
// How fast this machine does the work of a reconstruction, measured when a timed run begins. The plan is made
// from these rates (engine/reconstruct/plan.h), and checkpoints carry them, so that a resumed run has the
// same plan.
#pragma once

#include "core/base/clock.h"
#include "core/base/json_fwd.h"
#include "core/base/progress.h"
#include "engine/reconstruct/pixels.h"
#include "engine/reconstruct/presets.h"

namespace cei3d {

// Seconds per unit of work.
struct Rates {
  double sdf_step = 0;     // a step of Adam on the SDF field alone, 2048 points
  double trial_step = 0;   // a step of Adam on the SDF field of the trials (Preset::trial), 2048 points
  double albedo_step = 0;  // a step of Adam on the albedo field, of the appearance stage's batch
  double mesh = 0;         // a surface of n x n x n cells, with visibility, takes mesh n^2
  double hit_traced = 0;   // a pixel's ray to its hit
  double hit_shaded = 0;   // shading a hit
};
Json to_json(const Rates&);
Rates rates_from_json(const Json&);

// Times small pieces of work on untrained fields, whose surface is a sphere. About a second with hash grids
// on two cores. Error: interrupted.
Rates measure_rates(const Device&, const Preset&, const PixelStore&, const Clock&, const Progress&);

}  // namespace cei3d
