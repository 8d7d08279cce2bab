// SPDX-License-Identifier: Apache-2.0
// Removes a part of a mesh and closes the holes.
#pragma once

#include <span>

#include "model/geometry/mesh/mesh.h"
#include "model/geometry/shape/reshape.h"

namespace cei3d {

struct CutReport {
  size_t holes = 0;   // closed holes
  size_t pieces = 0;  // connected components of the result
};

struct CutResult {
  Reshape reshape;
  CutReport report;
};

// in_part: #V, 1 where a vertex belongs to the part. Ragged outlines are smoothed over a few edge lengths,
// and islands smaller than a fiftieth of the part's area join their surroundings. A triangle is removed when
// most of its corners are. Each hole is closed by a patch as fine as the mesh, which continues the tangents
// around it; its albedo is diffused from the rim. colors: #V, linear albedo. The mesh has normals. No edge is
// open afterwards that was not before. Errors: the part is empty, or everything.
CutResult cut(const Mesh&, std::span<const uint8_t> in_part, std::span<const Vec3f> colors);

}  // namespace cei3d
