// SPDX-License-Identifier: Apache-2.0
#include "engine/render/irradiance_map.h"

#include <cmath>

#include "core/compute/kernels/shade.h"
#include "core/math/tangents.h"

namespace cei3d {
namespace {

constexpr int kCells = 64;  // along a side: some 2 degrees apart

}  // namespace

IrradianceMap::IrradianceMap(const Device& device, const LobePlanes& lobes) {
  std::vector<Vec3f> nodes = map_node_directions(kCells);
  const int stride = padded_to_panels(int(nodes.size()));
  std::vector<float> normals(size_t(3) * stride, 0.0f), out(normals.size());
  for (size_t i = 0; i < nodes.size(); ++i) store_planes(normals.data(), stride, int(i), nodes[i]);
  device.launch<SgIrradiance>({lobes, stride, normals.data(), out.data()}, stride);
  for (size_t i = 0; i < nodes.size(); ++i) nodes[i] = load_planes<float>(out.data(), stride, int(i));
  map_ = DirectionMap(kCells, std::move(nodes));
}

Vec3f IrradianceMap::grad(Vec3f normal, Vec3f d_irradiance) const {
  constexpr float kStep = 1.5f / kCells;
  const auto [t, b] = tangents_of(normal, 2);
  const auto derivative_along = [&](Vec3f direction) {
    const Vec3f more = at(normal + direction * kStep), less = at(normal - direction * kStep);
    return dot(d_irradiance, more - less) / (2 * kStep);
  };
  return t * derivative_along(t) + b * derivative_along(b);
}

}  // namespace cei3d
