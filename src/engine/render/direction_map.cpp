// SPDX-License-Identifier: Apache-2.0
#include "engine/render/direction_map.h"

#include <algorithm>

#include "core/compute/kernels/shade.h"
#include "core/math/octahedron.h"

namespace cei3d {
namespace {

constexpr int kCells = 64, kNodes = kCells + 1;  // along a side
constexpr int kCount = kNodes * kNodes, kStride = padded_to_panels(kCount);
constexpr float kSkyRoughness = 0.2f;

float position_of(int node) { return float(node) * (2.0f / kCells) - 1; }

}  // namespace

std::vector<float> DirectionMap::node_directions() {
  std::vector<float> planes(size_t(3) * kStride, 0.0f);
  for (int i = 0; i < kCount; ++i)
    store_planes(planes.data(), kStride, i,
                 direction_from_octahedron({position_of(i % kNodes), position_of(i / kNodes)}));
  return planes;
}

DirectionMap::DirectionMap(std::span<const float> planes) {
  for (int i = 0; i < kCount; ++i) nodes_.push_back(load_planes<float>(planes.data(), kStride, i));
}

Vec3f DirectionMap::at(Vec3f direction) const {
  if (nodes_.empty()) return {0, 0, 0};
  const Vec2f p = octahedron_from_direction(direction);
  const float x = (p.x + 1) * (0.5f * kCells), y = (p.y + 1) * (0.5f * kCells);
  const int i = std::clamp(int(x), 0, kCells - 1), j = std::clamp(int(y), 0, kCells - 1);
  const float u = x - float(i), v = y - float(j);
  const Vec3f* n = &nodes_[size_t(j) * kNodes + i];
  return (n[0] * (1 - u) + n[1] * u) * (1 - v) + (n[kNodes] * (1 - u) + n[kNodes + 1] * u) * v;
}

DirectionMap irradiance_map(const Device& device, const LobePlanes& lobes) {
  const std::vector<float> normals = DirectionMap::node_directions();
  std::vector<float> out(normals.size());
  device.launch<SgIrradiance>({lobes, kStride, normals.data(), out.data()}, kStride);
  return DirectionMap(out);
}

DirectionMap sky_map(const Device& device, const LobePlanes& lobes) {
  const std::vector<float> axes = DirectionMap::node_directions(), roughness(kStride, kSkyRoughness);
  std::vector<float> out(axes.size());
  device.launch<SgReflection>({lobes, kStride, axes.data(), roughness.data(), out.data()}, kStride);
  return DirectionMap(out);
}

}  // namespace cei3d
