// SPDX-License-Identifier: Apache-2.0
// Finds the reconstructed surface below the simplified one, to bake from.
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "model/scene/scene.h"

namespace cei3d {

struct SurfaceBelow {
  std::vector<Hit> hits;
  std::vector<uint32_t> of_point;  // #hits, ascending; points without a hit are left out
};

// The points of the scene's surface that are nearest to some points along their normals, above or below, no
// farther than `reach`, and look the same way. points, normals (unit): #P, unit frame.
SurfaceBelow surface_below(const Device& device, const Scene& scene, std::span<const Vec3f> points,
                           std::span<const Vec3f> normals, float reach);

}  // namespace cei3d
