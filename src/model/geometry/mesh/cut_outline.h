// SPDX-License-Identifier: Apache-2.0
// Where to cut: from a vertex-wise labeling to the triangles that go and the loops they leave.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "model/geometry/mesh/mesh.h"

namespace cei3d {

// Labels with smooth outlines and without small islands. #V. What is smaller than the smoothing's reach stays
// as it is.
std::vector<uint8_t> clean_labels(const Mesh&, std::span<const uint8_t> in_part);

struct Outline {
  std::vector<uint8_t> removed;  // #F, 1: goes
  // Vertices around each hole, in the direction of the triangles to be put there
  std::vector<std::vector<uint32_t>> loops;
};
// Triangles that touch the outline at a mere corner go too, so that every vertex is on one loop at most,
// once.
Outline outline_of(const Mesh&, std::span<const uint8_t> in_part);

}  // namespace cei3d
