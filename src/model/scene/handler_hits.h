// SPDX-License-Identifier: Apache-2.0
// The handler points of a scene as hits, by which their albedo, material and parts are known.
#pragma once

#include <vector>

#include "model/geometry/shape/hit.h"
#include "model/scene/scene.h"

namespace cei3d {

// #handlers, on the present surface, so that they are known in every shape version. The scene must have
// handler points.
std::vector<Hit> handler_hits(const Scene&);

}  // namespace cei3d
