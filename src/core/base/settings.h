// SPDX-License-Identifier: Apache-2.0
// Settings by name: numbers and choices in the structs of an algorithm, each with its range, unit and source,
// which a user sets by "key=value".
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/json.h"

namespace cei3d {

struct SettingInfo {
  enum class Kind { whole, number, flag, choice };

  std::string key;     // "geometry.loss.eikonal"
  std::string what;    // a phrase that needs no other: "Weight of the mask loss"
  std::string unit;    // "steps", "1 / length"; empty: none
  std::string source;  // "[Wang et al. 2021]"; empty: found by trials
  Kind kind = Kind::number;
  double min = 0, max = 0;           // of a number, both allowed
  int multiple = 1;                  // whole numbers are multiples of it
  std::vector<std::string> choices;  // of a choice
};

// The value that a text stands for. Usage error, which names the key: not of the kind, out of range.
Json setting_value(const SettingInfo&, const std::string& text);
// Usage error: a value, from a file, that is not of the kind or out of range.
void check_setting(const SettingInfo&, const Json& value);
std::string range_text(const SettingInfo&);  // "1 to 100, a multiple of 4", "true or false"

// Adds to `values` (an object, by key) what was written: "key=value", or "@FILE.json" for a file that holds
// {"set": {"key": value, ...}}. Usage errors: another form, an unknown key (the nearest one is named), a
// value that its setting does not allow. Errors: a file that cannot be read, that has another key than "set".
void add_setting(std::span<const SettingInfo> known, const std::string& written, Json& values);
// Checks stored values as add_setting() checks written ones.
void check_settings(std::span<const SettingInfo> known, const Json& values);

// The settings in a struct Target.
template <class Target>
class SettingTable {
 public:
  void add(SettingInfo info, std::function<Json(Target&)> get,
           std::function<void(Target&, const Json&)> put) {
    infos_.push_back(std::move(info));
    access_.push_back({std::move(get), std::move(put)});
  }
  std::span<const SettingInfo> infos() const { return infos_; }
  Json get(size_t setting, Target target) const { return access_[setting].get(target); }
  // values: as add_setting() made them.
  void put(const Json& values, Target& target) const {
    for (size_t i = 0; i < infos_.size(); ++i)
      if (values.contains(infos_[i].key)) access_[i].put(target, values.at(infos_[i].key));
  }

 private:
  struct Access {
    std::function<Json(Target&)> get;
    std::function<void(Target&, const Json&)> put;
  };
  std::vector<SettingInfo> infos_;
  std::vector<Access> access_;
};

double shortest_decimal(float value);  // the decimal number with fewest digits that is the same float

struct SettingRange {
  double min = 0, max = std::numeric_limits<double>::infinity();
  int multiple = 1;
};

// Adds the members of one struct, Owner, somewhere in Target, under a common prefix.
template <class Target, class Owner>
class SettingGroup {
 public:
  using At = std::function<Owner&(Target&)>;
  SettingGroup(SettingTable<Target>& table, std::string prefix, At at)
      : table_(table), prefix_(std::move(prefix)), at_(std::move(at)) {}

  template <class Part>
  SettingGroup<Target, Part> part(const std::string& name, Part Owner::*member) const {
    return {table_, prefix_ + name, [at = at_, member](Target& t) -> Part& { return at(t).*member; }};
  }

  // A number or, of a bool, a switch.
  template <class T>
  const SettingGroup& add(const char* name, T Owner::*member, SettingRange range, const char* unit,
                          const char* what, const char* source = "") const {
    SettingInfo info{prefix_ + name, what,      unit,           source, kind_of<T>(),
                     range.min,      range.max, range.multiple, {}};
    table_.add(
        std::move(info), [at = at_, member](Target& t) { return json_of(at(t).*member); },
        [at = at_, member](Target& t, const Json& value) { at(t).*member = value.template get<T>(); });
    return *this;
  }

  template <class T>
  const SettingGroup& choice(const char* name, T Owner::*member, std::vector<std::pair<T, const char*>> names,
                             const char* what, const char* source = "") const {
    SettingInfo info{prefix_ + name, what, "", source, SettingInfo::Kind::choice, 0, 0, 1, {}};
    for (const auto& [value, word] : names) info.choices.push_back(word);
    table_.add(
        std::move(info),
        [at = at_, member, names](Target& t) {
          for (const auto& [value, word] : names)
            if (at(t).*member == value) return Json(word);
          return Json();
        },
        [at = at_, member, names](Target& t, const Json& wanted) {
          for (const auto& [value, word] : names)
            if (wanted == word) at(t).*member = value;
        });
    return *this;
  }

 private:
  template <class T>
  static constexpr SettingInfo::Kind kind_of() {
    if constexpr (std::is_same_v<T, bool>) return SettingInfo::Kind::flag;
    return std::is_integral_v<T> ? SettingInfo::Kind::whole : SettingInfo::Kind::number;
  }
  template <class T>
  static Json json_of(T value) {
    if constexpr (std::is_same_v<T, float>) return shortest_decimal(value);
    return value;
  }

  SettingTable<Target>& table_;
  std::string prefix_;
  At at_;
};

}  // namespace cei3d
