// SPDX-License-Identifier: Apache-2.0
// Table of the unoccluded sky irradiance over the normal. Irradiance varies slowly with the normal, so the
// table is as accurate as the sum over the lobes.
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
