// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/preset_settings.h"

#include <gtest/gtest.h>

#include <set>

#include "core/base/json.h"

namespace cei3d {
namespace {

// Another value that the setting allows.
Json other(const SettingInfo& s, const Json& value) {
  switch (s.kind) {
    case SettingInfo::Kind::flag:
      return !value.get<bool>();
    case SettingInfo::Kind::choice:
      return value == s.choices[0] ? s.choices[1] : s.choices[0];
    case SettingInfo::Kind::whole:
      return value.get<int64_t>() + s.multiple <= s.max ? value.get<int64_t>() + s.multiple
                                                        : value.get<int64_t>() - s.multiple;
    case SettingInfo::Kind::number:
      for (const double v : {0.5, 0.25, 2.0, 128.0})  // the same as floats
        if (v >= s.min && v <= s.max && value != v) return v;
  }
  return {};
}

Json all_values(const Preset& preset) {
  const SettingTable<Preset>& table = preset_settings();
  Json values = Json::object();
  for (size_t i = 0; i < table.infos().size(); ++i) values[table.infos()[i].key] = table.get(i, preset);
  return values;
}

TEST(PresetSettings, AllowWhatThePresetsHave) {
  for (const char* name : {"fast", "balanced", "paper"})
    EXPECT_NO_THROW(check_settings(preset_settings().infos(), all_values(preset_by_name(name)))) << name;
}

TEST(PresetSettings, EachChangesOneValueAndNoOther) {
  const Preset preset = preset_by_name("fast");
  const Json before = all_values(preset);
  EXPECT_EQ(before.size(), preset_settings().infos().size());  // no key twice
  for (const SettingInfo& s : preset_settings().infos()) {
    Json wanted = before;
    wanted[s.key] = other(s, before[s.key]);
    EXPECT_NO_THROW(check_setting(s, wanted[s.key])) << s.key;
    Preset changed = preset;
    preset_settings().put({{s.key, wanted[s.key]}}, changed);
    EXPECT_EQ(all_values(changed), wanted) << s.key;
  }
}

TEST(PresetSettings, HoldAgainstTheSizeOfAPixel) {
  Preset fitted = preset_by_name("fast");
  fit_to_footprint(fitted, 0.02);
  const Json before = all_values(preset_by_name("fast")), after = all_values(fitted);
  std::set<std::string> changed;
  for (const auto& [key, value] : before.items())
    if (value != after[key]) changed.insert(key);
  EXPECT_GE(changed.size(), 6u);
  for (const std::string& key : changed) EXPECT_TRUE(is_fitted(preset_by_name("fast"), key)) << key;
  EXPECT_FALSE(is_fitted(preset_by_name("paper"), "geometry.sdf.encoding.finest_resolution"));
}

}  // namespace
}  // namespace cei3d
