// SPDX-License-Identifier: Apache-2.0
// `edit material`: another roughness, specular, metalness or color, of the whole object or of a part.
#pragma once

#include <optional>
#include <string>

#include "core/compute/device.h"
#include "model/scene/scene.h"

namespace cei3d {

struct MaterialRequest {
  std::string id;    // of the new layer
  std::string part;  // empty: the whole object
  MaterialChange change;
  std::optional<Vec3f> color;  // linear
  bool keep_texture = true;    // of the color: scale what is there to it, instead of replacing it
};

struct MaterialReport {
  size_t points = 0;  // vertices of the present surface inside
  Vec3f mean{0, 0,
             0};  // linear base color before, over the surface; only with a color that keeps the texture
};

struct MaterialResult {
  EditLayer layer;
  MaterialReport report;
};

// Usage errors: nothing to change, values that are not in [0, 1] or not finite, no such part. Error: a part
// that is nowhere on the present surface.
MaterialResult change_material(const Device&, const Scene&, const MaterialRequest&);

// The linear base color below the layer, averaged over the part of the surface that it contains, by area.
// Error: it contains nothing.
Vec3f mean_color_inside(const Device&, const Scene&, const EditLayer&);

}  // namespace cei3d
