// SPDX-License-Identifier: Apache-2.0
// One writer per project. The lock is released when the process ends, however it ends.
#pragma once

#include <filesystem>
#include <optional>

#include "core/base/error.h"
#include "core/base/system.h"

namespace cei3d {

// Another process changes the project. Exit code 1.
class InUseError : public Error {
 public:
  explicit InUseError(const std::string& what) : Error(ErrorCode::failed, what) {}
};

class ProjectLock {
 public:
  ProjectLock() = default;                                    // holds nothing
  explicit ProjectLock(const std::filesystem::path& folder);  // InUseError
  bool held() const { return lock_.has_value(); }
  // Where the editor that holds it is found: InUseError says it to others. Nothing where it is not held.
  void say_address(const std::string& address) const;

 private:
  std::optional<FileLock> lock_;
};

}  // namespace cei3d
