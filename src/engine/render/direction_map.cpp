// SPDX-License-Identifier: Apache-2.0
#include "engine/render/direction_map.h"

#include <algorithm>

#include "core/math/bilinear.h"
#include "core/math/octahedron.h"

namespace cei3d {

std::vector<Vec3f> DirectionMap::node_directions(int cells) {
  const auto position_of = [&](int node) { return float(node) * (2.0f / float(cells)) - 1; };
  std::vector<Vec3f> out;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      out.push_back(direction_from_octahedron({position_of(i), position_of(j)}));
  return out;
}

Vec3f DirectionMap::at(Vec3f direction) const {
  if (nodes_.empty()) return {0, 0, 0};
  const Vec2f p = octahedron_from_direction(direction);
  const float half = 0.5f * float(cells_), x = (p.x + 1) * half, y = (p.y + 1) * half;
  const int i = std::clamp(int(x), 0, cells_ - 1), j = std::clamp(int(y), 0, cells_ - 1);
  const float u = x - float(i), v = y - float(j);
  const size_t row = size_t(cells_) + 1;
  const Vec3f* n = &nodes_[size_t(j) * row + size_t(i)];
  return bilinear(SquareCorners<Vec3f>{n[0], n[1], n[row], n[row + 1]}, u, v);
}

}  // namespace cei3d
