// SPDX-License-Identifier: Apache-2.0
// A starting surface: the field is fitted to the distance to the visual hull of the masks. Descent from a
// sphere can lose the object for good (prototype-findings, trap 1).
#pragma once

#include "model/field/field.h"
#include "model/geometry/visual_hull.h"

namespace cei3d {

// Signed distance to the hull's surface at every cell centre (negative inside), unit-sphere units, by two
// exact Euclidean distance transforms. [Felzenszwalb and Huttenlocher 2012]
std::vector<float> signed_distance(const VisualHull& hull);

// Fits output 0 of `sdf` to the hull shrunk by `margin`. Error when the hull is empty.
void prefit_to_hull(const Device&, Field& sdf, const VisualHull& hull, float margin, int steps, int levels,
                    uint64_t seed);

}  // namespace cei3d
