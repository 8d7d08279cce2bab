// SPDX-License-Identifier: Apache-2.0
// Table of light over directions, where it varies so slowly that the table is as accurate as the sum over the
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

// Unoccluded irradiance of the environment over the normal of the surface.
DirectionMap irradiance_map(const Device&, const LobePlanes&);
// Radiance of the environment, blurred by the reflection lobe of roughness 0.2.
DirectionMap sky_map(const Device&, const LobePlanes&);

}  // namespace cei3d
