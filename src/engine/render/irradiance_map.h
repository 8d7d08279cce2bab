// SPDX-License-Identifier: Apache-2.0
// Table of the unoccluded sky irradiance over the normal. Irradiance varies slowly with the normal, so the
// table is as accurate as the sum over the lobes.
#pragma once

#include "core/compute/device.h"
#include "core/compute/kernels/lobes.h"
#include "engine/render/direction_map.h"

namespace cei3d {

class IrradianceMap {
 public:
  IrradianceMap() = default;  // no light
  IrradianceMap(const Device&, const LobePlanes&);

  Vec3f at(Vec3f normal) const { return map_.at(normal); }  // normal: unit
  // dL/d(normal), tangent to the unit sphere, from dL/d(irradiance). By differences over the size of a cell,
  // at whose borders the table has kinks.
  Vec3f grad(Vec3f normal, Vec3f d_irradiance) const;

 private:
  DirectionMap map_;
};

}  // namespace cei3d
