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

// By name; none: there is no such file. folder: read from there instead, for work on the page; empty:
// embedded.
std::optional<std::string> asset(const std::string& name, const std::filesystem::path& folder = {});
std::string asset_type(const std::string& name);  // for Content-Type

}  // namespace cei3d
