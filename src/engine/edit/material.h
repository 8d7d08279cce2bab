// SPDX-License-Identifier: Apache-2.0
// `edit material`: changes roughness, specular, metalness or color of the object or of a part.
#pragma once

#include <optional>
#include <string>

#include "core/compute/device.h"
#include "model/scene/scene.h"

namespace cei3d {

struct MaterialRequest {
  std::string id;              // of the new layer
  std::string part;            // empty: the whole object
  MaterialChange change;       // its blend applies to the color, too
  std::optional<Vec3f> color;  // linear
  bool keep_texture = true;    // scale the present texture to the color instead of replacing it
};

struct MaterialReport {
  size_t points = 0;  // vertices of the present surface in the region
  // Mean linear albedo of the region before the edit; only with a color that keeps the texture.
  Vec3f mean{0, 0, 0};
};

struct MaterialResult {
  EditLayer layer;
  MaterialReport report;
};

// Usage errors: nothing to change, values outside [0, 1], a negative scale, anything not finite, no such
// part. Error: no surface is left of the part.
MaterialResult change_material(const Device&, const Scene&, const MaterialRequest&);

// Usage errors: values outside [0, 1], a negative scale, anything not finite, a roughness and a scale.
void check_change(const MaterialChange&);

// Area-weighted mean of the linear albedo below the layer, over its region. Error: the region is empty.
Vec3f mean_color_inside(const Device&, const Scene&, const EditLayer&);

}  // namespace cei3d
