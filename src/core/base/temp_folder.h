// SPDX-License-Identifier: Apache-2.0
// A new folder below the system's folder for temporary files, removed with its contents by the destructor.
#pragma once

#include <filesystem>

#include "core/base/error.h"
#include "core/base/system.h"

namespace cei3d {

class TempFolder {
 public:
  TempFolder() : path_(make_temporary_folder()) {}
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace cei3d
