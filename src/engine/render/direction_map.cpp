// SPDX-License-Identifier: Apache-2.0
#include "engine/render/direction_map.h"

namespace cei3d {

std::vector<Vec3f> map_node_directions(int cells) {
  const auto position_of = [&](int node) { return float(node) * (2.0f / float(cells)) - 1; };
  std::vector<Vec3f> out;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      out.push_back(direction_from_octahedron({position_of(i), position_of(j)}));
  return out;
}

}  // namespace cei3d
