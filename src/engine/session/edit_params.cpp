// SPDX-License-Identifier: Apache-2.0
#include "engine/session/edit_params.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/name_distance.h"
#include "core/math/color.h"
#include "engine/capture/capture.h"
#include "model/geometry/shape/camera_json.h"
#include "model/material/presets.h"

namespace cei3d {
namespace {

void put_share(const std::optional<double>& value, const char* name, Json& params) {
  if (!value) return;
  if (!(*value >= 0 && *value <= 1)) fail_usage("The {} {} is not in the range from 0 to 1.", name, *value);
  params[name] = *value;
}

void check_effects(const MaterialEffects& e) {
  if (!e.preset.empty())
    if (const std::string problem = unknown_preset(e.preset); !problem.empty()) fail_usage("{}", problem);
  if (e.blend && e.empty()) fail_usage("A blend needs something to blend: a material, a color or a value.");
  if (e.roughness && e.roughness_scale) fail_usage("Give a roughness or a roughness scale, not both.");
  if (e.roughness_scale && !(*e.roughness_scale >= 0 && std::isfinite(*e.roughness_scale)))
    fail_usage("The roughness scale {} is not a number of at least 0.", *e.roughness_scale);
  if (e.replace && e.color.empty()) fail_usage("'replace' goes with 'color'.");
  if (!e.color.empty()) color_from_text(e.color);
}

void put_preset(const MaterialPreset& preset, Effects& e) {
  e.change.roughness = preset.material.roughness;
  e.change.specular = preset.material.specular;
  e.change.metalness = preset.material.metalness;
  e.color = preset.color;
  e.replace = true;
}

}  // namespace

Vec3f color_from_text(const std::string& text) {
  const bool plain =
      text.size() == 7 && text[0] == '#' &&
      std::all_of(text.begin() + 1, text.end(), [](unsigned char c) { return std::isxdigit(c); });
  if (!plain)
    fail_usage("'{}' is not a color; write '#RRGGBB', two hexadecimal digits per channel, in quotes.", text);
  Vec3f color;
  for (int c = 0; c < 3; ++c)
    color[c] = linear_from_srgb(float(std::stoi(text.substr(1 + 2 * size_t(c), 2), nullptr, 16)) / 255);
  return color;
}

std::string material_preset_names() {
  std::string names;
  for (const MaterialPreset& p : material_presets())
    names += (names.empty() ? "" : ", ") + std::string(p.name);
  return names;
}

std::string unknown_preset(const std::string& name) {
  if (find_material_preset(name)) return "";
  constexpr size_t kNear = 2;  // letters
  std::string near;
  for (const MaterialPreset& p : material_presets())
    if (name_distance(name, p.name) <= kNear) near += (near.empty() ? "" : ", ") + std::string(p.name);
  const std::string problem = fmt::format("There is no material '{}'; ", name);
  return problem + (near.empty() ? "there are: " + material_preset_names() : "near names are: " + near) + ".";
}

Effects effects_from_params(JsonReader& params) {
  Effects e;
  if (const auto name = params.optional<std::string>("material")) {
    const MaterialPreset* preset = find_material_preset(*name);
    if (!preset)
      fail("{} has the material '{}', which this program does not know; update cei3d.", params.what(), *name);
    put_preset(*preset, e);
  }
  if (const auto r = params.optional<float>("roughness")) e.change.roughness = r;
  if (const auto s = params.optional<float>("specular")) e.change.specular = s;
  if (const auto m = params.optional<float>("metalness")) e.change.metalness = m;
  if (const auto s = params.optional<float>("roughness_scale")) {
    e.change.roughness_scale = s;
    e.change.roughness.reset();
  }
  e.change.blend = params.optional("blend", 1.0f);
  const bool replace = params.optional("replace", false);
  if (const auto color = params.optional<std::string>("color")) {
    e.color = color_from_text(*color);
    e.replace = replace;
  }
  return e;
}

EditPlace place_from(const Capture& capture, JsonReader& params) {
  if (params.has("camera")) {
    if (params.has("view")) fail("{} has a view and a camera.", params.what());
    JsonReader reader = params.object("camera");
    const Camera camera = camera_from_json(reader);
    reader.finish();
    check_camera(camera, reader.what());
    EditPlace own;
    own.name = "of the edit's own camera";
    own.camera = camera;
    return own;
  }
  return {find_view(capture, params.require<std::string>("view")), true};
}

void put_place(const Capture& capture, const std::string& view, const std::optional<Camera>& camera,
               Json& params) {
  if (camera && !view.empty()) fail_usage("Give a view or a camera, not both.");
  if (!camera) {
    params["view"] = find_view(capture, view).name;
    return;
  }
  check_camera(*camera, "The camera of the edit");
  params["camera"] = camera_json(*camera);
}

void put_effects(const MaterialEffects& effects, Json& params) {
  check_effects(effects);
  if (!effects.preset.empty()) params["material"] = effects.preset;
  put_share(effects.roughness, "roughness", params);
  put_share(effects.specular, "specular", params);
  put_share(effects.metalness, "metalness", params);
  if (effects.roughness_scale) params["roughness_scale"] = *effects.roughness_scale;
  put_share(effects.blend, "blend", params);
  if (effects.color.empty()) return;
  params["color"] = effects.color;
  if (effects.replace) params["replace"] = true;
}

void put_settings(std::span<const SettingInfo> known, const std::vector<std::string>& written, Json& params) {
  if (written.empty()) return;
  params["set"] = Json::object();
  for (const std::string& w : written) add_setting(known, w, params["set"]);
}

void refuse_settings(const Json& params, const std::string& prefix, const std::string& needs) {
  if (!params.contains("set")) return;
  for (const auto& [key, value] : params.at("set").items())
    if (key.starts_with(prefix)) fail_usage("The setting {} has no effect here: {}.", key, needs);
}

}  // namespace cei3d
