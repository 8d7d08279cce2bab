// SPDX-License-Identifier: Apache-2.0
// Files of the repository that tests read, whatever folder they run in.
#pragma once

#include <filesystem>

namespace cei3d {

// path: from the root of the repository. CEI3D_SOURCE is set by the build.
inline std::filesystem::path source_file(const char* path) {
  return std::filesystem::path(CEI3D_SOURCE) / path;
}

}  // namespace cei3d
