// SPDX-License-Identifier: Apache-2.0
#include "apps/server/library.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/json.h"
#include "core/base/system.h"
#include "engine/capture/capture.h"
#include "engine/project/project.h"

namespace cei3d {
namespace fs = std::filesystem;

Json LibraryEntry::json() const {
  return {{"id", name},
          {"name", name},
          {"kind", kind == Kind::project ? "project" : "capture"},
          {"finished", finished},
          {"problem", problem}};
}

std::optional<LibraryEntry> entry_at(const fs::path& path) {
  using Kind = LibraryEntry::Kind;
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(path, error);
  const std::string name = whole.filename().string();
  if (Project::is_project(path))
    return LibraryEntry{Kind::project, path, name, fs::exists(path / "base/scene.json", error)};
  if (!is_capture(path)) return std::nullopt;
  LibraryEntry entry{Kind::capture, path, name};
  try {
    load_capture(path);
  } catch (const Error& e) {
    entry.problem = e.what();
  }
  return entry;
}

std::vector<LibraryEntry> entries_below(const fs::path& folder) {
  std::vector<LibraryEntry> entries;
  std::error_code error;
  const std::string root = fs::weakly_canonical(folder, error).string() + "/";
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code ignored;
    if (!it->is_directory(ignored) || !fs::weakly_canonical(it->path(), ignored).string().starts_with(root))
      continue;
    if (auto entry = entry_at(it->path())) entries.push_back(std::move(*entry));
  }
  std::sort(entries.begin(), entries.end(),
            [](const LibraryEntry& a, const LibraryEntry& b) { return a.name < b.name; });
  return entries;
}

std::optional<fs::path> sample_capture() {
  std::error_code error;
  for (fs::path at = program_file().parent_path(); at.has_relative_path(); at = at.parent_path())
    for (const char* place : {"samples/spot", "share/cei3d/samples/spot"})
      if (fs::is_directory(at / place, error)) return at / place;
  return std::nullopt;
}

}  // namespace cei3d
