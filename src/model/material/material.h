// SPDX-License-Identifier: Apache-2.0
// Material of a surface point besides its albedo.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/math/brdf.h"

namespace cei3d {

// The metallic-roughness model that glTF, Blender and Disney share; its formulas are in core/math/shading.h.
// The albedo is a field of its own.
struct Material {
  float roughness = 0.3f;           // [0, 1]; alpha of GGX is its square
  float specular = kUsualSpecular;  // [0, 1]; of the dielectric part: F0 = 0.08 specular, and f90_of()
  float metalness = 0;              // [0, 1]

  bool operator==(const Material&) const = default;
};

// Mean of the materials of a triangle's corners at a point of it, by its barycentrics b1 and b2. of: #V.
inline Material material_at_corners(std::span<const Material> of, const std::array<uint32_t, 3>& t, float b1,
                                    float b2) {
  const Material &a = of[t[0]], &b = of[t[1]], &c = of[t[2]];
  const float b0 = 1 - b1 - b2;
  const auto mean = [&](float Material::*x) { return a.*x * b0 + b.*x * b1 + c.*x * b2; };
  return {mean(&Material::roughness), mean(&Material::specular), mean(&Material::metalness)};
}

}  // namespace cei3d
