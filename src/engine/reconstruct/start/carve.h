// SPDX-License-Identifier: Apache-2.0
// Carves concavities, which masks do not show, by colors. A coarse grid of free densities and colors (no
// surface, no dependence on the view) is fitted to the images inside the visual hull [Sun et al. 2022; Yu et
// al. 2022]; cells that become empty although light reaches them are removed from the hull. Densities find a
// hollow in seconds that a distance field, which can only move its surface, does not find.
#pragma once

#include "core/base/progress.h"
#include "engine/reconstruct/pixels.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

struct CarveOptions {
  int steps = 400;
  int rays = 8192;              // per step
  float density = 2;            // initial density, per unit length
  float density_rate = 0.05f;   // maximum change of the opacity of a cell per step
  float color_rate = 0.02f;     // maximum change of a color per step, display units
  float opacity_weight = 0.3f;  // weight of the mask loss against the color loss
  float empty_opacity = 0.3f;   // cells with a lower opacity are empty, if they are lit
  float lit = 0.3f;             // a cell is lit if this share of the light of any ray reaches it
  int opening = 1;              // hollows narrower than 2 * opening + 1 cells are removed as noise
  uint64_t seed = 1;
};

// The hull without the cells that are empty and lit. The same bits for any number of threads.
VisualHull carve(const PixelStore&, const VisualHull&, const CarveOptions&,
                 const Progress& progress = Progress());

}  // namespace cei3d
