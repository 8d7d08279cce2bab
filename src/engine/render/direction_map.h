// SPDX-License-Identifier: Apache-2.0
// A function of the direction as a table on an octahedron's square [Engelhardt and Dachsbacher 2008],
// bilinear between its nodes.
#pragma once

#include <utility>
#include <vector>

#include "core/math/vec.h"

namespace cei3d {

class DirectionMap {
 public:
  DirectionMap() = default;  // zero everywhere
  // nodes: values at node_directions(cells).
  DirectionMap(int cells, std::vector<Vec3f> nodes) : cells_(cells), nodes_(std::move(nodes)) {}

  // Directions of the nodes of a square of `cells` cells a side, row by row: #(cells + 1)^2.
  static std::vector<Vec3f> node_directions(int cells);

  Vec3f at(Vec3f direction) const;  // direction: unit

 private:
  int cells_ = 0;
  std::vector<Vec3f> nodes_;
};

}  // namespace cei3d
