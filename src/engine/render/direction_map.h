// SPDX-License-Identifier: Apache-2.0
// Light by direction as a table, where it changes so slowly that a table is as good as the sum over the
// lobes.
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "core/compute/kernels/lobes.h"

namespace cei3d {

class DirectionMap {
 public:
  DirectionMap() = default;  // no light
  // planes: [3][stride], values for the directions of the table's nodes, some 2 degrees apart.
  explicit DirectionMap(std::span<const float> planes);
  static std::vector<float> node_directions();  // [3][stride]

  Vec3f at(Vec3f direction) const;  // direction: unit

 private:
  std::vector<Vec3f> nodes_;  // of an octahedron's square, row by row
};

// Irradiance of the free sky by the normal of what it falls on.
DirectionMap irradiance_map(const Device&, const LobePlanes&);
// Radiance of the free sky, blurred by the reflection lobe of a roughness of .2.
DirectionMap sky_map(const Device&, const LobePlanes&);

}  // namespace cei3d
