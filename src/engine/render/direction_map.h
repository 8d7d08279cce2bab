// SPDX-License-Identifier: Apache-2.0
// A function of the direction as a table on an octahedron's square [Engelhardt and Dachsbacher 2008],
// bilinear between its nodes.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "core/math/bilinear.h"
#include "core/math/octahedron.h"
#include "core/math/vec.h"

namespace cei3d {

// Directions of the nodes of a square of `cells` cells a side, row by row: #(cells + 1)^2.
std::vector<Vec3f> map_node_directions(int cells);

// V: value with float * V and V + V; zero as V{}.
template <class V>
class DirectionMapOf {
 public:
  DirectionMapOf() = default;  // zero everywhere
  // nodes: values at map_node_directions(cells).
  DirectionMapOf(int cells, std::vector<V> nodes) : cells_(cells), nodes_(std::move(nodes)) {}

  V at(Vec3f direction) const {  // direction: unit
    if (nodes_.empty()) return V{};
    const Vec2f p = octahedron_from_direction(direction);
    const float half = 0.5f * float(cells_), x = (p.x + 1) * half, y = (p.y + 1) * half;
    const int i = std::clamp(int(x), 0, cells_ - 1), j = std::clamp(int(y), 0, cells_ - 1);
    const size_t row = size_t(cells_) + 1;
    const V* n = &nodes_[size_t(j) * row + size_t(i)];
    return bilinear(SquareCorners<V>{n[0], n[1], n[row], n[row + 1]}, x - float(i), y - float(j));
  }

 private:
  int cells_ = 0;
  std::vector<V> nodes_;
};

using DirectionMap = DirectionMapOf<Vec3f>;

}  // namespace cei3d
