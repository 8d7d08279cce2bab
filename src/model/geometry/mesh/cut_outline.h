// SPDX-License-Identifier: Apache-2.0
// From a labeling of vertices to the triangles to remove and the loops around the holes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// The labels with smoothed outlines and without small islands, #V. Parts smaller than the smoothing's reach
// are not smoothed.
std::vector<uint8_t> clean_labels(const Mesh&, std::span<const uint8_t> in_part);

struct Outline {
  std::vector<uint8_t> removed;  // #F, 1: removed
  // Vertices around each hole, in the order of the triangles that will fill it.
  std::vector<std::vector<uint32_t>> loops;
};
// The outline of a part. Triangles that touch it only at a corner are removed, too, so that every vertex is
// on at most one loop, once.
Outline outline_of(const Mesh&, std::span<const uint8_t> in_part);

}  // namespace cei3d
