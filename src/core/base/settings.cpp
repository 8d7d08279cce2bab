// SPDX-License-Identifier: Apache-2.0
#include "core/base/settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/json_reader.h"
#include "core/base/name_distance.h"
#include "core/base/parse_json.h"

namespace cei3d {
namespace {

using Kind = SettingInfo::Kind;

const SettingInfo& setting_named(std::span<const SettingInfo> known, const std::string& key) {
  std::vector<std::string> keys;
  for (const SettingInfo& s : known) {
    if (s.key == key) return s;
    keys.push_back(s.key);
  }
  // The end of a key, when only one has it, is nearer than any spelling.
  std::vector<std::string> ends;
  for (const std::string& k : keys)
    if (k.ends_with("." + key)) ends.push_back(k);
  fail_usage("There is no setting '{}'; did you mean '{}'?", key,
             ends.empty() ? nearest_name(key, keys) : ends.front());
}

[[noreturn]] void wrong(const SettingInfo& s, const std::string& found) {
  fail_usage("The setting {} is '{}'; it must be {}.", s.key, found, range_text(s));
}

bool fits(const SettingInfo& s, const Json& v) {
  switch (s.kind) {
    case Kind::flag:
      return v.is_boolean();
    case Kind::choice:
      return v.is_string() &&
             std::find(s.choices.begin(), s.choices.end(), v.get<std::string>()) != s.choices.end();
    case Kind::whole:
      if (!v.is_number_integer()) return false;
      break;
    case Kind::number:
      if (!v.is_number()) return false;
  }
  const auto number = v.get<double>();
  if (!(number >= s.min && number <= s.max) || !std::isfinite(number)) return false;
  return s.kind == Kind::number || v.get<int64_t>() % s.multiple == 0;
}

template <class T>
Json number_of(const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

void add_file(std::span<const SettingInfo> known, const std::string& path, Json& values) {
  const Json file = parse_json(read_file(path));
  if (!file.is_object() || !file.contains("set") || !file.at("set").is_object())
    fail_usage("{} should hold {{\"set\": {{\"key\": value, ...}}}}.", path);
  JsonReader reader(file, path);
  const Json& set = reader.member("set");
  reader.finish();
  check_settings(known, set);
  values.update(set);
}

}  // namespace

double shortest_decimal(float value) { return std::stod(fmt::format("{}", value)); }

std::string range_text(const SettingInfo& s) {
  if (s.kind == Kind::flag) return "true or false";
  if (s.kind == Kind::choice) return "one of " + fmt::format("{}", fmt::join(s.choices, ", "));
  std::string text = s.kind == Kind::whole ? "a whole number" : "a number";
  text += std::isfinite(s.max) ? fmt::format(" from {} to {}", s.min, s.max)
                               : fmt::format(" of at least {}", s.min);
  if (s.multiple > 1) text += fmt::format(", a multiple of {}", s.multiple);
  return text;
}

Json setting_value(const SettingInfo& s, const std::string& text) {
  Json value;
  if (s.kind == Kind::whole) value = number_of<int64_t>(text);
  if (s.kind == Kind::number) value = number_of<double>(text);
  if (s.kind == Kind::choice) value = text;
  if (s.kind == Kind::flag && (text == "true" || text == "false")) value = text == "true";
  if (!fits(s, value)) wrong(s, text);
  return value;
}

void check_setting(const SettingInfo& s, const Json& value) {
  if (!fits(s, value)) wrong(s, value.dump());
}

void add_setting(std::span<const SettingInfo> known, const std::string& written, Json& values) {
  if (written.starts_with('@')) return add_file(known, written.substr(1), values);
  const size_t equals = written.find('=');
  if (equals == std::string::npos || equals == 0)
    fail_usage("The setting '{}' should be key=value, or @FILE.json.", written);
  const SettingInfo& s = setting_named(known, written.substr(0, equals));
  values[s.key] = setting_value(s, written.substr(equals + 1));
}

void check_settings(std::span<const SettingInfo> known, const Json& values) {
  if (!values.is_object()) fail("Settings should be a JSON object of keys and values.");
  for (const auto& [key, value] : values.items()) check_setting(setting_named(known, key), value);
}

}  // namespace cei3d
