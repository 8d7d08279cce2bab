// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace cei3d {

// The metallic-roughness model that glTF, Blender and Disney share. Base colour a(x) is a field of its own:
// diffuse = (1 - metalness) a / pi, F0 = (1 - metalness) 0.08 specular + metalness a.
struct Material {
  float roughness = 0.3f;  // GGX alpha = roughness^2
  float specular = 0.5f;   // [0, 1]; 0.5 is F0 = 0.04
  float metalness = 0;     // [0, 1]
};

}  // namespace cei3d
