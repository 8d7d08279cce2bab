// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cei3d {

// The metallic-roughness model that glTF, Blender and Disney share; its formulas are in core/math/shading.h.
// The albedo is a field of its own.
struct Material {
  float roughness = 0.3f;  // [0, 1]; alpha of GGX is its square
  float specular = 0.5f;   // [0, 1]; of the dielectric part: F0 = 0.08 specular
  float metalness = 0;     // [0, 1]

  bool operator==(const Material&) const = default;
};

}  // namespace cei3d
