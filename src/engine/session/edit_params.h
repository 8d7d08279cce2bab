// SPDX-License-Identifier: Apache-2.0
// Parameters that several edits have in common, between commands and what is stored.
#pragma once

#include "core/base/json_reader.h"
#include "core/math/vec.h"
#include "engine/session/requests.h"
#include "model/material/change.h"

namespace cei3d {

// A color as users write it, '#RRGGBB' in sRGB, to linear. Usage error: anything else.
Vec3f color_from_text(const std::string& text);

// Keys "material" (name of a preset), "roughness", "roughness_scale", "specular", "metalness", "color"
// ('#rrggbb'), "replace" and "blend" of the parameters of an edit.
struct Effects {
  MaterialChange change;       // its blend is also that of the color
  std::optional<Vec3f> color;  // linear
  bool replace = false;        // of the color: it replaces what is there instead of scaling it
};
// A preset's values come first, the others replace them. Error: a preset that this program does not know.
Effects effects_from_params(JsonReader& params);
// Writes the keys that the command has. Usage errors: no such preset, values out of range, no color,
// --replace without a color, --blend without anything else, two ways to say the roughness.
void put_effects(const MaterialEffects&, Json& params);

}  // namespace cei3d
