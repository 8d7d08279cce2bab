// SPDX-License-Identifier: Apache-2.0
// Irradiance of the free sky by the normal of what it falls on. It changes so slowly with the normal that a
// table is as good as the sum over the lobes.
#pragma once

#include <vector>

#include "core/compute/device.h"
#include "core/compute/kernels/lobes.h"

namespace cei3d {

class IrradianceMap {
 public:
  IrradianceMap() = default;  // no light
  IrradianceMap(const Device&, const LobePlanes&);

  Vec3f at(Vec3f normal) const;  // normal: unit

 private:
  std::vector<Vec3f> nodes_;  // of an octahedron's square, row by row
};

}  // namespace cei3d
