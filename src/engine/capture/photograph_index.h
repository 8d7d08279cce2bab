// SPDX-License-Identifier: Apache-2.0
// Finds images by the names that programs give them in their files of cameras.
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace cei3d {

class PhotographIndex {
 public:
  // Indexes the images in a folder and below, but not those in folders for masks. Sub-folders to a depth of
  // four.
  explicit PhotographIndex(const std::filesystem::path& root);

  // The image of a name: a path of which only the end has to fit, from any system, with or without suffix.
  // Where several fit, that with the longest common end, then the first in sorted order. None:
  // root/images/NAME. Of a HEIC file the JPEG beside it, which is made where there is none.
  std::filesystem::path find(const std::string& name) const;

 private:
  std::filesystem::path root_;
  std::multimap<std::string, std::filesystem::path> by_stem_;
};

}  // namespace cei3d
