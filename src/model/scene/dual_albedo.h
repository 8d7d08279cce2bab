// SPDX-License-Identifier: Apache-2.0
// Dual albedo: the base field, and in the regions of edits the branch of the edit. [paper eq. 9]
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "model/scene/scene.h"

namespace cei3d {

struct RoutedAlbedo {
  std::vector<Vec3f> albedo;  // #hits, linear base colour
  std::vector<int> layer;     // #hits, the last layer whose region contains the hit; -1: none does
};

// A later layer covers an earlier one; a layer without an albedo of its own shows what lies below it. A hit
// that no region contains gets exactly (bit for bit) base's own value, whatever else is in the batch.
RoutedAlbedo routed_albedo(const Device&, const Field& base, std::span<const EditLayer> layers,
                           std::span<const Hit> hits);

}  // namespace cei3d
