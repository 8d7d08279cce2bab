// SPDX-License-Identifier: Apache-2.0
// Files that the browser sent: scribbles, masks, environments. Named by a hash of their content, and deleted
// when the program ends.
#pragma once

#include <deque>
#include <filesystem>
#include <mutex>
#include <string>

#include "core/base/temp_folder.h"

namespace cei3d {

class Uploads {
 public:
  // name: of the user's file; see plain_file_name(). Returns the id.
  std::string add(const std::string& name, const std::string& bytes);
  // Error (ErrorCode::again): there is no such upload here, perhaps since the program was restarted, or newer
  // ones took its place.
  std::filesystem::path path(const std::string& id) const;
  std::string bytes(const std::string& id) const;

 private:
  static constexpr size_t kMax = 200;  // files; the oldest are deleted first
  TempFolder folder_;
  mutable std::mutex mutex_;
  std::deque<std::pair<std::string, std::string>> files_;  // id, name
};

// Letters, digits and . _ - of the last part of a name, at most 80; "file" if none is left.
std::string plain_file_name(const std::string& name);

}  // namespace cei3d
