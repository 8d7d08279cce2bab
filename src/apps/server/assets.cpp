// SPDX-License-Identifier: Apache-2.0
#include "apps/server/assets.h"

#include <algorithm>
#include <span>

#include "core/base/error.h"
#include "core/base/file.h"
#include "engine/page/page_files.h"

namespace cei3d {

std::span<const Asset> embedded_assets();  // generated

namespace {

bool is_plain(const std::string& name) {
  const auto allowed = [](unsigned char c) {
    return std::isalnum(c) || c == '.' || c == '_' || c == '-' || c == '/';
  };
  return std::all_of(name.begin(), name.end(), allowed) && name.find("..") == std::string::npos &&
         !name.starts_with('/');
}

}  // namespace

std::optional<std::string> asset(const std::string& name, const std::filesystem::path& folder) {
  if (!is_plain(name)) return std::nullopt;
  if (!folder.empty()) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(folder / name, error)) return std::nullopt;
    return read_file(folder / name);
  }
  for (const Asset& a : embedded_assets())
    if (a.name == name) return std::string(a.bytes);
  for (const PageFile& f : page_files())
    if (f.name == name) return std::string(f.bytes);
  return std::nullopt;
}

std::string asset_type(const std::string& name) {
  if (name.ends_with(".html")) return "text/html; charset=utf-8";
  if (name.ends_with(".js")) return "text/javascript; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  if (name.ends_with(".svg")) return "image/svg+xml";
  return "application/octet-stream";
}

}  // namespace cei3d
