// SPDX-License-Identifier: Apache-2.0
// Finds out what a path holds: a project, a capture, or a folder of them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/base/json_fwd.h"

namespace cei3d {

struct LibraryEntry {
  enum class Kind { project, capture } kind = Kind::project;
  std::filesystem::path path;
  std::string name;
  bool finished = true;      // of a project: its object is made
  std::string problem = {};  // why a capture cannot be loaded; empty: it can
  Json json() const;         // id: its name
};

// The project or capture at a path; none: it holds neither. A damaged capture is returned with its problem.
std::optional<LibraryEntry> entry_at(const std::filesystem::path&);
// The entries directly below a folder, by name; symbolic links that lead out of it are left out.
std::vector<LibraryEntry> entries_below(const std::filesystem::path&);
// The sample capture that comes with the program; none: it is not there.
std::optional<std::filesystem::path> sample_capture();

}  // namespace cei3d
