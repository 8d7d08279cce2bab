// SPDX-License-Identifier: Apache-2.0
// Fits the field to the signed distance of a start shape (docs/method.md#start-shape).
#pragma once

#include "core/base/progress.h"
#include "model/field/field.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

// Signed distance to the hull's surface at every cell center (negative inside), unit frame, by two
// exact Euclidean distance transforms. [Felzenszwalb and Huttenlocher 2012]
std::vector<float> signed_distance(const VisualHull& hull);

// A signed distance on a grid over the unit cube [-1, 1]^3.
struct DistanceGrid {
  int n = 0;                  // cells per axis
  std::vector<float> values;  // [z][y][x], at cell centers
  float at(Vec3f p) const;    // trilinear, clamped to the grid
};

struct PrefitOptions {
  int steps = 300;
  float layer_rate = 2e-3f;  // Adam rate of the layers
  int levels = -1;           // hash levels in use; -1: all
  uint64_t seed = 1;
};

// Fits output 0 of `sdf` to the grid; three of four training points are near its surface. Errors: the grid
// has no surface; interrupted.
void prefit(const Device&, Field& sdf, const DistanceGrid& grid, const PrefitOptions&,
            const Progress& progress = Progress());

}  // namespace cei3d
