// SPDX-License-Identifier: Apache-2.0
// For tests: keys that a reader of JSON should refuse.
#pragma once

#include <string>
#include <vector>

#include "core/base/error_of.h"
#include "core/base/json.h"

namespace cei3d {

inline void add_object_paths(const Json& j, const Json::json_pointer& at,
                             std::vector<Json::json_pointer>& out) {
  if (j.is_object()) {
    out.push_back(at);
    for (const auto& [key, value] : j.items()) add_object_paths(value, at / key, out);
  } else if (j.is_array()) {
    for (size_t i = 0; i < j.size(); ++i) add_object_paths(j[i], at / i, out);
  }
}

// Adds an unknown key to each object of the JSON, one at a time. Returns the paths of the objects where
// read(changed) has no error, or one that does not name the key and `what`.
template <class Read>
std::vector<std::string> objects_with_unknown_keys_read(const Json& good, const std::string& what,
                                                        const Read& read) {
  std::vector<Json::json_pointer> paths;
  add_object_paths(good, Json::json_pointer(), paths);
  std::vector<std::string> out;
  for (const Json::json_pointer& path : paths) {
    Json bad = good;
    bad[path]["surprise"] = 1;
    const std::string said = message([&] { read(bad); });
    if (said.find("unknown key 'surprise'") == std::string::npos || said.find(what) == std::string::npos)
      out.push_back(path.to_string() + ": " + said);
  }
  return out;
}

}  // namespace cei3d
