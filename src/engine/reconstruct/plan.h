// SPDX-License-Identifier: Apache-2.0
// How the time of a reconstruction is divided among its stages.
#pragma once

#include "engine/reconstruct/presets.h"
#include "engine/reconstruct/reconstruct.h"

namespace cei3d {

// Seconds; 0: no limit, the steps count.
struct Plan {
  double geometry = 0;
  double polish = 0,
         between = 0;  // a round of polishing; the mesh, its hits and a brief look at them before it
  double appearance = 0, residual = 0;
  double refinement = 0;  // one, with its hits
  double finishing = 0;   // the finer mesh at the end
  double saving = 0;      // the mesh before all that, and the object after it
  int iterations = 0;     // of the geometry stage
  int rounds = 0, polish_steps = 0;
  int refinements = 0;  // of the albedo, on other pixels
  bool finish = false;  // with the finer mesh, Preset::finished
  int residual_steps = 0;
  size_t residual_hits = 0;  // that it learns from
};

// pixels: all of training.
Plan plan_of(const ReconstructOptions&, const Preset&, size_t pixels);

}  // namespace cei3d
