// SPDX-License-Identifier: Apache-2.0
// Ambient occlusion of the vertices, for exported materials.
#pragma once

#include <vector>

#include "model/geometry/shape/surface.h"

namespace cei3d {

// #V of the surface, [0, 1]: how much of the sky above a vertex is visible from it, weighted by the cosine.
std::vector<float> sky_shares(const Surface& surface);

}  // namespace cei3d
