// SPDX-License-Identifier: Apache-2.0
// How the time of a reconstruction is divided among its stages.
#pragma once

#include "core/base/json.h"
#include "engine/reconstruct/pixels.h"
#include "engine/reconstruct/presets.h"
#include "engine/reconstruct/rates.h"
#include "engine/reconstruct/reconstruct.h"

namespace cei3d {

// How much time and how many steps each stage gets. A run of the joint descent alone has joint_steps, joint
// and reserve, and may have a finer mesh. In a run by steps all seconds are 0: no limit, the step counts
// decide.
struct Plan {
  StageChoice stages = StageChoice::all;
  // Coupled: no polishing, appearance, refinements and joint descent; a network is the color.
  ColorChoice color = ColorChoice::disentangled;
  int trial_steps = 0;        // of each training that tries one of three start shapes; 0: none is tried
  bool hull_alone = false;    // whether of these shapes the hull alone is tried, to refine the cameras
  double alignment = 0;       // s after which no trial with cameras that were moved begins; 0: no limit
  Start start = Start::hull;  // if none is tried
  double geometry = 0;        // s, the comparison of starts included
  int iterations = 0;         // steps of the geometry stage where `geometry` is 0
  // s of finding out on the trained surface how the light moves; 0: known, or in the time of polishing.
  double light_motion = 0;
  int polish_rounds = 0;  // of polishing
  double look = 0;        // s that a round takes to make a mesh and estimate light and material briefly
  double polish = 0;      // s of a polishing round's descent, at most
  int polish_steps = 0;   // steps of a polishing round's descent, at most
  Effort effort = Effort::full;  // of the appearance stage
  double appearance = 0;         // s of the appearance stage
  double descent = 0;            // s of its descent alone
  int refinements = 0;           // of the albedo, each on another random subset of the pixels
  int spare_refinements = 0;     // further ones, for which no time is planned: if there is some left
  double refinement = 0;         // s of one refinement
  int joint_steps = 0;           // of the joint descent, at most; 0: none
  double joint = 0;              // s of the joint descent, with the judgment of its result
  bool has_finer_mesh = false;   // Preset::finer_meshing
  double finer_mesh = 0;         // s of the finer mesh
  size_t residual_pixels = 0;    // of all residual images, at most; 0: none
  int residual_steps = 0;        // of training the network of a coupled color, at most
  size_t residual_hits = 0;      // training pixels of that network, at most
  double residual = 0;           // s of the residual images, or of that network
  double reserve = 0;            // s for the first surface and for reading and writing files
};

// What the plan depends on, of the training pixels.
struct PlannedPixels {
  size_t count = 0;
  // Whether many photographs cut the object off, so that its visual hull is far from its shape.
  bool cut_off = false;
};
PlannedPixels planned_pixels(const PixelStore&);

// Usage error: a choice of stages and of color that exclude each other.
// rates: of this machine; not read for a run by steps.
Plan plan_of(const ReconstructOptions&, const Preset&, const PlannedPixels&, const Rates& rates);

// Share of the appearance stage's descent that there is time for. left: s of the run before it.
double affordable_descent(const Plan&, double left);
// Whether there is time for the finer mesh. left: s of the run before it.
bool has_time_for_finer_mesh(const Plan&, double left);
// Seconds of the residual images, at least half of what was planned. left: s of the run before them.
double seconds_of_residual(const Plan&, double left);
Json to_json(const Plan&);

}  // namespace cei3d
