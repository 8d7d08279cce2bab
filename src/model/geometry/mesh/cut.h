// SPDX-License-Identifier: Apache-2.0
// Takes a part off a mesh and closes what was behind it.
#pragma once

#include <span>

#include "model/geometry/mesh/mesh.h"
#include "model/geometry/shape/reshape.h"

namespace cei3d {

struct CutReport {
  size_t holes = 0;   // that were closed
  size_t pieces = 0;  // connected ones that are left
};

struct CutResult {
  Reshape reshape;
  CutReport report;
};

// in_part: #V, 1 where a vertex belongs to the part; ragged outlines are smoothed by a few edge lengths, and
// islands of less than a fiftieth of the part's area join what surrounds them. A triangle goes with the
// majority of its corners. Each hole is closed by a patch as fine as the mesh that carries on the tangents
// around it; its color is diffused from the surroundings. colors: #V, linear base color. The mesh has
// normals. No edge is open afterwards that was not before. Errors: a part that is nothing, or everything.
CutResult cut(const Mesh&, std::span<const uint8_t> in_part, std::span<const Vec3f> colors);

}  // namespace cei3d
