// SPDX-License-Identifier: Apache-2.0
// What the surface is like where rays meet it: base colour and material, edits included. Base colour is
// "dual": the base field, and in the regions of edits the branch of the edit. [paper eq. 9]
#pragma once

#include <span>
#include <vector>

#include "core/compute/device.h"
#include "model/scene/scene.h"

namespace cei3d {

struct Appearance {
  std::vector<Vec3f> albedo;       // #hits, linear base colour
  std::vector<uint32_t> material;  // #hits, index of the hit's material
  std::vector<Material>
      materials;           // those that occur; the first is the object's own, whether it occurs or not
  std::vector<int> layer;  // #hits, the last layer with a region of its own that contains the hit; -1: none
};

// Layers are applied in their order: a branch covers what lies below it, a tint recolours it, a material
// replaces the values it names. A hit that no layer contains gets exactly (bit for bit) the base's own value,
// whatever else is in the batch.
Appearance appearance_at(const Device&, const Scene&, std::span<const Hit> hits);

}  // namespace cei3d
