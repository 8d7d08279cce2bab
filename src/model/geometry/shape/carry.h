// SPDX-License-Identifier: Apache-2.0
// Handler points follow a change of geometry.
#pragma once

#include "model/geometry/shape/handlers.h"
#include "model/geometry/shape/reshape.h"

namespace cei3d {

// Each follows the vertex nearest to it, is gone where that vertex's triangles are, and is added on new
// matter. before, after: the mesh before and after the change.
HandlerPoints carried(const HandlerPoints&, const Mesh& before, const Mesh& after, const Reshape& change);

}  // namespace cei3d
