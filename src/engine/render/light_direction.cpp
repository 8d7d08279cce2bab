// SPDX-License-Identifier: Apache-2.0
#include "engine/render/light_direction.h"

#include "core/base/parallel.h"
#include "core/math/color.h"

namespace cei3d {
namespace {

constexpr int kCells = 32;  // along a side: the mean over half a sky changes slowly

}  // namespace

DirectionMap light_directions(const SkyRadiance& radiance) {
  const std::vector<Vec3f>& sky = sky_directions();
  std::vector<Vec3f> nodes = DirectionMap::node_directions(kCells);
  parallel_for(int(nodes.size()), [&](int i) {
    const Vec3f normal = nodes[size_t(i)];
    Vec3f sum{0, 0, 0};
    float total = 1e-12f;
    for (int k = 0; k < kSkyDirections; ++k) {
      const float weight = luminance(radiance[size_t(k)]) * max(dot(normal, sky[size_t(k)]), 0.0f);
      sum += sky[size_t(k)] * weight;
      total += weight;
    }
    nodes[size_t(i)] = sum / total;
  });
  return {kCells, std::move(nodes)};
}

}  // namespace cei3d
