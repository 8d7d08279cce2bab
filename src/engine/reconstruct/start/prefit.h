// SPDX-License-Identifier: Apache-2.0
// A starting surface: the field is fitted to the distance to the visual hull of the masks, carved by the
// colours. Descent from a sphere can lose the object for good (docs/method.md#start-shape).
#pragma once

#include "model/field/field.h"
#include "model/geometry/shape/visual_hull.h"

namespace cei3d {

// Signed distance to the hull's surface at every cell centre (negative inside), unit-sphere units, by two
// exact Euclidean distance transforms. [Felzenszwalb and Huttenlocher 2012]
std::vector<float> signed_distance(const VisualHull& hull);

// A signed distance on a grid over the unit cube [-1, 1]^3.
struct DistanceGrid {
  int n = 0;                  // cells an axis
  std::vector<float> values;  // [z][y][x], at cell centres
  float at(Vec3f p) const;    // trilinear, clamped to the grid
};

// Fits output 0 of `sdf` to the grid, most of all near its surface. layer_rate: Adam's. Error when it has no
// surface.
void prefit(const Device&, Field& sdf, const DistanceGrid& grid, int steps, float layer_rate, int levels,
            uint64_t seed);

}  // namespace cei3d
