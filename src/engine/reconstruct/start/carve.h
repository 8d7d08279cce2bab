// SPDX-License-Identifier: Apache-2.0
// What the masks cannot tell and the colors can: concavities. A coarse grid of free densities and colors
// (no surface, no dependence on the view) is fitted to the pictures inside the visual hull; cells that come
// out empty although light reaches them are taken off the hull. Densities have no shape to keep, so they find
// a hollow in seconds that a distance field, which can only move its surface, does not find at all. [the fit:
// Sun et al. 2022; Yu et al. 2022]
#pragma once

#include "core/base/progress.h"
#include "engine/reconstruct/pixels.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

struct CarveOptions {
  int steps = 400, rays = 8192;  // a step
  float density = 2;             // to begin with, per unit length: the whole hull is a thin fog
  float density_rate = 0.05f, color_rate = 0.02f;  // largest change a step: opacity of a cell; display units
  float opacity_weight = 0.3f;                     // of the masks, against the colors
  float empty_opacity = 0.3f;                      // of a cell; below it the cell is empty,
  float lit = 0.3f;                                // if at least this share of some ray's light got there
  int opening = 1;  // hollows narrower than 2 x this many cells and one are noise
  uint64_t seed = 1;
};

// The hull without its visibly empty cells. Same bits whatever the number of threads.
VisualHull carve(const PixelStore&, const VisualHull&, const CarveOptions&,
                 const Progress& progress = Progress());

}  // namespace cei3d
