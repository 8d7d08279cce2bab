// SPDX-License-Identifier: Apache-2.0
// Handler points after a change of shape.
#pragma once

#include "model/geometry/shape/handlers.h"
#include "model/geometry/shape/reshape.h"

namespace cei3d {

// Each point moves with the nearest vertex, is dropped where that vertex's triangles were removed, and points
// are added on new surface. before, after: the mesh before and after the change.
HandlerPoints carried(const HandlerPoints&, const Mesh& before, const Mesh& after, const Reshape& change);

}  // namespace cei3d
