// SPDX-License-Identifier: Apache-2.0
#include "engine/render/light_direction.h"

#include "core/base/parallel.h"
#include "core/math/color.h"

namespace cei3d {
namespace {

constexpr int kCells = 32;  // along a side: the mean over half a sky changes slowly

}  // namespace

LightDirectionMap light_directions(const SkyRadiance& radiance) {
  const std::vector<Vec3f>&sky = sky_directions(), normals = map_node_directions(kCells);
  std::vector<LightDirection> nodes(normals.size());
  parallel_for(int(nodes.size()), [&](int i) {
    LightDirection sum{};
    float total = 1e-12f;
    for (int k = 0; k < kSkyDirections; ++k) {
      const float cosine = max(dot(normals[size_t(i)], sky[size_t(k)]), 0.0f),
                  weight = luminance(radiance[size_t(k)]) * cosine, enters_flat = grazing(cosine);
      sum = sum + weight * LightDirection{sky[size_t(k)], sky[size_t(k)] * enters_flat, enters_flat};
      total += weight;
    }
    nodes[size_t(i)] = (1 / total) * sum;
  });
  return {kCells, std::move(nodes)};
}

}  // namespace cei3d
