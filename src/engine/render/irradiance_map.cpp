// SPDX-License-Identifier: Apache-2.0
#include "engine/render/irradiance_map.h"

#include <algorithm>

#include "core/compute/kernels/shade.h"
#include "core/math/octahedron.h"

namespace cei3d {
namespace {

constexpr int kCells = 64, kNodes = kCells + 1;  // along a side: some 2 degrees apart
constexpr int kCount = kNodes * kNodes, kStride = padded_to_panels(kCount);

float position_of(int node) { return float(node) * (2.0f / kCells) - 1; }

}  // namespace

IrradianceMap::IrradianceMap(const Device& device, const LobePlanes& lobes) {
  std::vector<float> normals(size_t(3) * kStride, 0.0f), out(normals.size());
  for (int i = 0; i < kCount; ++i) {
    const Vec3f n = direction_from_octahedron({position_of(i % kNodes), position_of(i / kNodes)});
    for (int c = 0; c < 3; ++c) normals[size_t(c) * kStride + i] = n[c];
  }
  device.launch<SgIrradiance>({lobes, kStride, normals.data(), out.data()}, kStride);
  nodes_.resize(kCount);
  for (int i = 0; i < kCount; ++i) nodes_[i] = {out[i], out[kStride + i], out[2 * kStride + i]};
}

Vec3f IrradianceMap::at(Vec3f normal) const {
  if (nodes_.empty()) return {0, 0, 0};
  const Vec2f p = octahedron_from_direction(normal);
  const float x = (p.x + 1) * (0.5f * kCells), y = (p.y + 1) * (0.5f * kCells);
  const int i = std::clamp(int(x), 0, kCells - 1), j = std::clamp(int(y), 0, kCells - 1);
  const float u = x - float(i), v = y - float(j);
  const Vec3f* n = &nodes_[size_t(j) * kNodes + i];
  return (n[0] * (1 - u) + n[1] * u) * (1 - v) + (n[kNodes] * (1 - u) + n[kNodes + 1] * u) * v;
}

Vec3f IrradianceMap::grad(Vec3f normal, Vec3f d_irradiance) const {
  constexpr float kStep = 1.5f / kCells;
  const Vec3f t = normalize(cross(std::abs(normal.z) < 0.9f ? Vec3f{0, 0, 1} : Vec3f{1, 0, 0}, normal)),
              b = cross(normal, t);
  const auto slope = [&](Vec3f along) {
    const Vec3f more = at(normal + along * kStep), less = at(normal - along * kStep);
    return dot(d_irradiance, more - less) / (2 * kStep);
  };
  return t * slope(t) + b * slope(b);
}

}  // namespace cei3d
