// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/reconstruct/preset_settings.h"
#include "engine/session/requests.h"

namespace cei3d {

SettingsReport settings_of_preset(const std::string& name) {
  const SettingTable<Preset>& table = preset_settings();
  const Preset preset = preset_by_name(name);
  SettingsReport r{name, {}};
  for (size_t i = 0; i < table.infos().size(); ++i)
    r.settings.push_back({table.infos()[i], table.get(i, preset), is_fitted(preset, table.infos()[i].key)});
  return r;
}

Json settings_from_text(const std::vector<std::string>& written) {
  Json values = Json::object();
  for (const std::string& w : written) add_setting(preset_settings().infos(), w, values);
  return values;
}

Json SettingsReport::json() const {
  Json list = Json::array();
  for (const Line& l : settings) {
    Json j = {{"key", l.info.key}, {"value", l.value}, {"range", range_text(l.info)}, {"what", l.info.what}};
    if (!l.info.unit.empty()) j["unit"] = l.info.unit;
    if (!l.info.source.empty()) j["source"] = l.info.source;
    if (l.fitted) j["fitted_to_pixels"] = true;
    list.push_back(std::move(j));
  }
  return {{"preset", preset}, {"settings", list}};
}

std::string SettingsReport::text() const {
  std::string text;
  for (const Line& l : settings) {
    const std::string value = l.value.is_string() ? l.value.get<std::string>() : l.value.dump();
    text += fmt::format("{} = {}{}{}\n    {}; {}{}{}\n", l.info.key, value, l.info.unit.empty() ? "" : " ",
                        l.info.unit, l.info.what, range_text(l.info), l.info.source.empty() ? "" : " ",
                        l.info.source);
    if (l.fitted) text += "    fitted to the size of a pixel on the object, unless it is set\n";
  }
  return text;
}

}  // namespace cei3d
