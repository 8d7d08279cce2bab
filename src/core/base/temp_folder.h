// SPDX-License-Identifier: Apache-2.0
// A new folder below the system's folder for temporary files, removed with all that is in it when the object
// goes.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

#include "core/base/error.h"

namespace cei3d {

class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "cei3d-XXXXXX").string();
    if (!::mkdtemp(name.data())) fail("Cannot make a temporary folder like {}.", name);
    path_ = name;
  }
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
