// SPDX-License-Identifier: Apache-2.0
#include "core/base/error.h"
#include "core/base/json.h"
#include "engine/edit/albedo_branch.h"
#include "engine/edit/deform.h"
#include "engine/edit/part.h"
#include "engine/reconstruct/preset_settings.h"
#include "engine/session/requests.h"

namespace cei3d {
namespace {

template <class Target>
std::vector<SettingsReport::Line> lines_of(const SettingTable<Target>& table, const Target& target) {
  std::vector<SettingsReport::Line> lines;
  for (size_t i = 0; i < table.infos().size(); ++i) lines.push_back({table.infos()[i], table.get(i, target)});
  return lines;
}

}  // namespace

SettingsReport settings_of_preset(const std::string& name) {
  const Preset preset = preset_by_name(name);
  SettingsReport r{"preset", name, lines_of(preset_settings(), preset)};
  for (SettingsReport::Line& l : r.settings) l.fitted = is_fitted(preset, l.info.key);
  return r;
}

SettingsReport settings_of_edit(const std::string& edit) {
  SettingsReport r{"edit", edit, {}};
  if (edit == "paint") r.settings = lines_of(branch_settings(), BranchOptions());
  if (edit == "part") r.settings = lines_of(part_settings(), PartOptions());
  if (edit == "deform") r.settings = lines_of(deform_settings(), DeformOptions());
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
  return {{kind, name}, {"settings", list}};
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
