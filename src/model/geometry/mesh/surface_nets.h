// SPDX-License-Identifier: Apache-2.0
// Surface nets: the zero level set of a signed distance field as a mesh with one vertex in every cell that
// the surface passes through, moved onto the surface. Rounder triangles than marching cubes and no case
// table. [Gibson 1998]
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "core/base/progress.h"
#include "model/field/field.h"
#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// Signed distances of points, negative inside.
using DistancesAt = std::function<std::vector<float>(std::span<const Vec3f>)>;

// Mesh without normals. Vertices are placed by linear interpolation along the edges of a cell. Surface
// outside the unit sphere is cut off. resolution: cells along [-1, 1]; a multiple of 4.
Mesh surface_net(const DistancesAt& distances, int resolution, const Progress& progress = Progress());

struct MeshingOptions {
  int resolution = 192;          // cells along [-1, 1]; a multiple of 4
  float smallest_part = 0.002f;  // connected components with a smaller share of all triangles are dropped
};

// Vertices lie on the zero set to about 1e-4; normals are sdf_normals(). Error when the field has no zero set
// in the unit sphere.
Mesh extract_mesh(const Device&, const Field& sdf, const MeshingOptions& options,
                  const Progress& progress = Progress());

}  // namespace cei3d
