// SPDX-License-Identifier: Apache-2.0
// The JSON files of a project: damage becomes an Error that names the file.
#pragma once

#include <filesystem>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"
#include "core/base/parse_json.h"

namespace cei3d {

inline Json parse_json_file(const std::filesystem::path& path) {
  const std::string text = read_file(path);
  if (nested_too_deep(text))
    fail("{} is damaged (nested too deep); restore it from a copy of the project.", path.string());
  try {
    return Json::parse(text);
  } catch (const Json::exception& e) {
    fail("{} is damaged (not JSON: {}); restore it from a copy of the project.", path.string(), e.what());
  }
}

// Calls read(JSON of the file); a key that is missing or of another type becomes an Error that names the
// file.
template <class F>
auto read_json_file(const std::filesystem::path& path, F read) {
  const Json j = parse_json_file(path);
  try {
    return read(j);
  } catch (const Json::exception& e) {
    fail("{} is damaged ({}); restore it from a copy of the project.", path.string(), e.what());
  }
}

inline void write_json_file(const std::filesystem::path& path, const Json& j) {
  write_file_atomic(path, j.dump(1) + "\n");
}

}  // namespace cei3d
