// SPDX-License-Identifier: Apache-2.0
// Model sizes and schedules by name. A preset is data: the same code runs all of them.
#pragma once

#include <string>

#include "engine/reconstruct/appearance/appearance_stage.h"
#include "engine/reconstruct/appearance/surface_polish.h"
#include "engine/reconstruct/geometry/geometry_stage.h"
#include "engine/reconstruct/joint/joint_descent.h"
#include "engine/reconstruct/start/start.h"
#include "model/geometry/mesh/surface_nets.h"

namespace cei3d {

// Where the distance field begins: from one of several start shapes, which short trainings compare; from the
// visual hull; or as a sphere, of which the photographs say nothing (model/field/sphere_start.h).
enum class StartChoice { trials, hull, sphere };
// What is trained: the surface by volume rendering, then light and material on it; or everything together by
// the joint descent alone, from start values (engine/reconstruct/joint/start_values.h).
enum class StageChoice { all, joint };

// What the object's color is made of: light, albedo and material; or, for comparison, a network over position
// and direction alone.
enum class ColorChoice { disentangled, coupled };

struct Preset {
  StartChoice start = StartChoice::trials;
  StageChoice stages = StageChoice::all;
  ColorChoice color = ColorChoice::disentangled;
  float start_radius = 0.5f;  // of the sphere
  GeometryOptions geometry;
  TrialOptions trial;  // with the networks of "fast" in all presets
  AppearanceOptions appearance;
  PolishOptions polish;
  JointOptions joint;
  MeshingOptions meshing;              // of the surface on which light and material are fitted, by vertex
  MeshingOptions finer_meshing;        // of the finished object, whose silhouettes are those of its mesh
  bool resolution_from_views = false;  // grids as fine as the pixels, see fit_to_footprint()
  int larger_tables = 0;               // added to the logarithm of the hash tables that it chooses
  int polish_steps = 600;              // of a round, at most; half of them in a run by steps
  int joint_steps = 0;                 // of the joint descent, at most; half of them in a run by steps
  // Of the network of a coupled color, at most; half of them in a run by steps.
  int residual_steps = 9000;
  int refinement_steps = 600;  // of the albedo on another subset of the pixels
  int iterations = 0;  // of the main stage, geometry or joint, when neither a time nor a number is asked for
  int polish_from_iterations = 1000;  // geometry steps from which an untimed run polishes and meshes finer
  int exposures_from_steps = 1000;  // geometry steps of a model that is compared with the exposures of views
  int trials_from_iterations = 4000;  // geometry steps from which an untimed run compares start shapes
  size_t max_hits = 1500000;          // training pixels of the appearance stage
  size_t brief_hits = 300000;         // training pixels that make the handler points of a joint descent alone
  // Training pixels of the network of a coupled color; it overfits the noise of fewer.
  size_t max_residual_hits = 4000000;
  size_t max_residual_pixels = 24000000;  // of all residual images; 0: none
};

// "fast" (hash grids), "balanced" (larger ones, for longer), "paper" (the paper's own method: the joint
// descent alone on networks over frequencies, 8x512 for the SDF and 4x512 for the albedo). Usage error for
// any other name.
Preset preset_by_name(const std::string& name);

// Sets the hash grids and meshes from the size of a pixel on the object (unit frame): all those of a
// preset that asks for it, the trial's always.
void fit_to_footprint(Preset& preset, double pixel_footprint);

}  // namespace cei3d
