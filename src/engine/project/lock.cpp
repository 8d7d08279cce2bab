// SPDX-License-Identifier: Apache-2.0
#include "engine/project/lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "core/base/error.h"

namespace cei3d {

ProjectLock::ProjectLock(const std::filesystem::path& folder) {
  const std::string file = (folder / ".lock").string();
  fd_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (fd_ < 0) fail("Cannot write to project {}: {}.", folder.string(), std::strerror(errno));
  if (::flock(fd_, LOCK_EX | LOCK_NB) == 0) return;
  const int code = errno;
  ::close(std::exchange(fd_, -1));
  if (code == EWOULDBLOCK)
    fail("Project {} is in use by another cei3d that changes it; wait until that is done, or stop it.",
         folder.string());
  fail("Cannot lock project {}: {}.", folder.string(), std::strerror(code));
}

ProjectLock::~ProjectLock() {
  if (fd_ >= 0) ::close(fd_);
}
ProjectLock::ProjectLock(ProjectLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
ProjectLock& ProjectLock::operator=(ProjectLock&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

}  // namespace cei3d
