// SPDX-License-Identifier: Apache-2.0
#include "engine/evaluate/kept_values.h"

#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/parse_json.h"

namespace cei3d {

Json KeptValues::find(const std::string& name, const Json& settings) const {
  if (!std::filesystem::exists(file(name))) return nullptr;
  const Json kept = parse_json(read_file(file(name)));
  if (!kept.is_object() || kept.size() != 2 || !kept.contains("settings") || !kept.contains("value"))
    return nullptr;  // not by this version: it is computed again
  return kept.at("settings") == settings ? kept.at("value") : Json();
}

void KeptValues::put(const std::string& name, const Json& settings, const Json& value) const {
  write_file_atomic(file(name), Json{{"settings", settings}, {"value", value}}.dump(1) + "\n");
}

}  // namespace cei3d
