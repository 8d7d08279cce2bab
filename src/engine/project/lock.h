// SPDX-License-Identifier: Apache-2.0
// One writer a project. The lock belongs to the process: it is gone with it, however it ends.
#pragma once

#include <filesystem>

namespace cei3d {

class ProjectLock {
 public:
  ProjectLock() = default;
  explicit ProjectLock(const std::filesystem::path& folder);  // error when another process writes there
  ~ProjectLock();
  ProjectLock(ProjectLock&&) noexcept;
  ProjectLock& operator=(ProjectLock&&) noexcept;
  bool held() const { return fd_ >= 0; }

 private:
  int fd_ = -1;
};

}  // namespace cei3d
