// SPDX-License-Identifier: Apache-2.0
// Materials by name, for edits.
#pragma once

#include <span>
#include <string_view>

#include "core/math/vec.h"
#include "model/material/material.h"

namespace cei3d {

struct MaterialPreset {
  const char* name;
  Vec3f color;  // linear: reflectance along the normal of a metal, albedo of a dielectric
  Material material;
};

std::span<const MaterialPreset> material_presets();
// Null: no preset has that name. "aluminium" is accepted for "aluminum".
const MaterialPreset* find_material_preset(std::string_view name);

}  // namespace cei3d
