// SPDX-License-Identifier: Apache-2.0
// The mesh of a made-up body, as ground truth.
#pragma once

#include "engine/synthetic/body.h"
#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// The surface as triangles, with normals. resolution: cells along [-1, 1], a multiple of 4. Vertices lie on
// the surface to about 1e-5.
Mesh body_mesh(const Body&, int resolution);

}  // namespace cei3d
