// SPDX-License-Identifier: Apache-2.0
// The files of the page, as CMake embeds them from src/web (cmake/editor.cmake).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace cei3d {

struct Asset {
  std::string_view name;  // "editor/main.js", relative to src/web
  std::string_view bytes;
};

// The file of that name; none: there is no such file. folder: where to read it from, for work on the page;
// empty: the embedded file.
std::optional<std::string> asset(const std::string& name, const std::filesystem::path& folder = {});
std::string asset_type(const std::string& name);  // for Content-Type

}  // namespace cei3d
