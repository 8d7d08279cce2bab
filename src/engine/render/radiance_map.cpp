// SPDX-License-Identifier: Apache-2.0
#include "engine/render/radiance_map.h"

#include <cmath>

#include "engine/render/lobe_frames.h"

namespace cei3d {
namespace {

constexpr int kCells = 64;          // along a side: some 2 degrees apart
constexpr float kRoughness = 0.2f;  // half of the energy of the lobe is within 5 degrees

}  // namespace

DirectionMap radiance_map(const Device& device, const LobePlanes& light) {
  std::vector<Vec3f> nodes = map_node_directions(kCells);
  const int stride = padded_to_panels(int(nodes.size()));
  LobeFrames lobes{stride};
  const Vec3f round{0, 0, 0};  // a lobe without a plane of incidence
  for (size_t i = 0; i < nodes.size(); ++i) lobes.put(i, {nodes[i], round, kRoughness, 1});
  std::vector<float> out(size_t(3) * stride);
  device.launch<SgReflection>({light, stride, lobes.planes(), out.data()}, stride);
  for (size_t i = 0; i < nodes.size(); ++i) nodes[i] = load_planes<float>(out.data(), stride, int(i));
  return {kCells, std::move(nodes)};
}

}  // namespace cei3d
