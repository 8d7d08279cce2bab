// SPDX-License-Identifier: Apache-2.0
// Cuts a surface into charts: connected sets of faces that look nearly the same way, compact, with borders
// that are about straight.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "model/geometry/unwrap/face_graph.h"

namespace cei3d {

// A partition of the faces of a graph.
struct Charts {
  std::vector<uint32_t> of_face;  // #F
  uint32_t count = 0;

  std::vector<std::vector<uint32_t>> faces() const;  // of each chart, ascending
};

// Grown from seeds that move to the middles of their charts [Lloyd 1982; Sander et al. 2003], then joined
// where the normals of the union still differ little. Finally single faces at a border move to the
// neighboring chart where they fit better, which makes the border smooth.
Charts grow_charts(const FaceGraph& graph);

// The connected parts of a set of faces.
std::vector<std::vector<uint32_t>> connected_parts(const FaceGraph& graph, std::span<const uint32_t> faces);

}  // namespace cei3d
