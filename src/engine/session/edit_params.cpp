// SPDX-License-Identifier: Apache-2.0
#include "engine/session/edit_params.h"

#include <algorithm>
#include <cctype>

#include "core/base/error.h"
#include "core/math/color.h"

namespace cei3d {
namespace {

void put_share(const std::optional<double>& value, const char* name, Json& params) {
  if (!value) return;
  if (!(*value >= 0 && *value <= 1)) fail_usage("--{} {} is not in the range from 0 to 1.", name, *value);
  params[name] = *value;
}

}  // namespace

Vec3f color_from_text(const std::string& text) {
  const bool plain =
      text.size() == 7 && text[0] == '#' &&
      std::all_of(text.begin() + 1, text.end(), [](unsigned char c) { return std::isxdigit(c); });
  if (!plain)
    fail_usage("'{}' is not a color; write '#RRGGBB', two hexadecimal digits a channel, in quotes.", text);
  Vec3f color;
  for (int c = 0; c < 3; ++c)
    color[c] = linear_from_srgb(float(std::stoi(text.substr(1 + 2 * size_t(c), 2), nullptr, 16)) / 255);
  return color;
}

Effects effects_from_params(JsonReader& params) {
  Effects e;
  e.change = {params.optional<float>("roughness"), params.optional<float>("specular"),
              params.optional<float>("metalness")};
  if (const auto color = params.optional<std::string>("color")) e.color = color_from_text(*color);
  e.replace = params.optional("replace", false);
  return e;
}

void put_effects(const MaterialEffects& effects, Json& params) {
  put_share(effects.roughness, "roughness", params);
  put_share(effects.specular, "specular", params);
  put_share(effects.metalness, "metalness", params);
  if (effects.replace && effects.color.empty()) fail_usage("--replace goes with --color.");
  if (effects.color.empty()) return;
  color_from_text(effects.color);
  params["color"] = effects.color;
  if (effects.replace) params["replace"] = true;
}

}  // namespace cei3d
