// SPDX-License-Identifier: Apache-2.0
// Model sizes and schedules by name. A preset is data: the same code runs all of them.
#pragma once

#include <string>

#include "engine/reconstruct/appearance/appearance_stage.h"
#include "engine/reconstruct/appearance/surface_polish.h"
#include "engine/reconstruct/geometry/geometry_stage.h"
#include "model/geometry/mesh/surface_nets.h"

namespace cei3d {

struct Preset {
  GeometryOptions geometry;
  AppearanceOptions appearance;
  PolishOptions polish;
  MeshingOptions meshing;          // of what is fitted: light and material have unknowns by vertex
  MeshingOptions finished;         // of the object in the end: its silhouettes are those of its mesh
  int iterations;                  // of the geometry stage when neither a time nor a number is asked for
  bool resolution_from_views;      // grids as fine as the pixels: finest_resolution and log2_table follow the
                                   // capture
  size_t most_hits = 1500000;      // training pixels of the appearance stage
  size_t residual_hits = 4000000;  // ... and of the residual, which learns the noise of fewer
  double stretch = 1;              // how many times as long as with "fast" what follows the geometry takes
};

// "fast" (hash grids), "balanced" (the same for longer), "paper" (the paper's networks: 8x512 SDF, 4x512
// albedo, frequency encodings). Usage error for any other name.
Preset preset_by_name(const std::string& name);

// Sets the grids of a preset from the size of a pixel on the object (unit-sphere units).
void fit_to_footprint(Preset& preset, double pixel_footprint);

}  // namespace cei3d
