// SPDX-License-Identifier: Apache-2.0
// Parameters that several edits have in common: from commands to stored JSON and back.
#pragma once

#include "core/base/json_reader.h"
#include "core/base/settings.h"
#include "core/math/camera.h"
#include "core/math/vec.h"
#include "engine/session/requests.h"
#include "model/material/change.h"
#include "model/scene/view.h"

namespace cei3d {

// A color as users write it, '#RRGGBB' in sRGB, to linear. Usage error: anything else.
Vec3f color_from_text(const std::string& text);

// Keys "material" (name of a preset), "roughness", "roughness_scale", "specular", "metalness", "color"
// ('#rrggbb'), "replace" and "blend" of the parameters of an edit.
struct Effects {
  MaterialChange change;       // its blend applies to the color, too
  std::optional<Vec3f> color;  // linear
  bool replace = false;        // the color replaces the texture instead of scaling it
};
// The other keys override the preset's values. Error: an unknown preset.
Effects effects_from_params(JsonReader& params);
// Writes the keys that the command sets. Usage errors: no such preset, values out of range, no color,
// "replace" without a color, "blend" alone, both roughness and roughness scale.
void put_effects(const MaterialEffects&, Json& params);

// Where an edit was made: a view of the capture, or a camera of its own. Key "view", a name, or "camera", as
// camera_json() writes it.
struct EditPlace : View {  // of an own camera, the name is for messages
  bool is_view = false;    // of the capture
};
// Errors: neither or both of the keys, an unknown view.
EditPlace place_from(const Capture&, JsonReader& params);
// Writes the key. Usage errors: neither or both, an unknown view.
void put_place(const Capture&, const std::string& view, const std::optional<Camera>&, Json& params);

// Key "set": numbers and choices of how the edit is made. written: "key=value", as users write them; none: no
// key. Usage errors: those of add_setting().
void put_settings(std::span<const SettingInfo> known, const std::vector<std::string>& written, Json& params);
// Usage error: "set" has a key that begins so, which nothing would read. needs: what is missing.
void refuse_settings(const Json& params, const std::string& prefix, const std::string& needs);
// Whether there are any. Usage errors: those of check_settings().
template <class Target>
bool settings_from(JsonReader& params, const SettingTable<Target>& table, Target& target) {
  if (!params.has("set")) return false;
  check_settings(table.infos(), params.member("set"));
  table.put(params.member("set"), target);
  return true;
}

}  // namespace cei3d
