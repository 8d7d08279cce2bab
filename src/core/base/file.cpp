// SPDX-License-Identifier: Apache-2.0
#include "core/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>

#include "core/base/error.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

// What the user can do about an errno.
std::string reason(int code) {
  switch (code) {
    case ENOENT:
      return "there is no such file; check the path";
    case EACCES:
    case EPERM:
      return "no permission; check the rights of the file and its folder";
    case EROFS:
      return "the disk is read-only; choose another place";
    case ENOSPC:
    case EDQUOT:
      return "the disk is full; free some space and try again";
    case EISDIR:
      return "it is a folder, not a file";
    default:
      return std::strerror(code);
  }
}

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() { close(); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return fd_; }
  bool close() {  // some file systems report a full disk only here
    const int fd = fd_;
    fd_ = -1;
    return fd < 0 || ::close(fd) == 0;
  }

 private:
  int fd_;
};

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    bytes.remove_prefix(size_t(n));
  }
  return true;
}

void make_parent(const fs::path& path) {
  if (path.parent_path().empty()) return;
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) fail("Cannot make folder {}: {}.", path.parent_path().string(), reason(error.value()));
}

fs::path temporary_name(const fs::path& path) {
  static std::atomic<unsigned> count{0};  // two threads may write the same target
  return path.parent_path() / fmt::format("{}.tmp-{}-{}", path.filename().string(), ::getpid(), count++);
}

// The rename is on disk only once its folder is; best effort, some file systems cannot sync folders.
void sync_folder(const fs::path& path) {
  const fs::path folder = path.parent_path().empty() ? fs::path(".") : path.parent_path();
  const Descriptor fd(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (fd.get() >= 0) ::fsync(fd.get());
}

}  // namespace

std::string read_file(const fs::path& path) {
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat info {};
  if (fd.get() < 0 || ::fstat(fd.get(), &info) != 0)
    fail("Cannot read {}: {}.", path.string(), reason(errno));
  if (S_ISDIR(info.st_mode)) fail("Cannot read {}: {}.", path.string(), reason(EISDIR));
  // +1: sees the end at once.
  std::string bytes(S_ISREG(info.st_mode) ? size_t(info.st_size) + 1 : 65536, '\0');
  size_t used = 0;
  while (true) {  // to the end, not to st_size: pipes and growing files
    if (used == bytes.size()) bytes.resize(2 * used);
    const ssize_t n = ::read(fd.get(), bytes.data() + used, bytes.size() - used);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("Cannot read {}: {}.", path.string(), reason(errno));
    if (n == 0) break;
    used += size_t(n);
  }
  bytes.resize(used);
  return bytes;
}

void write_file_atomic(const fs::path& path, std::string_view bytes) {
  make_parent(path);
  const fs::path temporary = temporary_name(path);
  Descriptor fd(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (fd.get() < 0) fail("Cannot write {}: {}.", path.string(), reason(errno));
  const bool written = write_all(fd.get(), bytes) && ::fsync(fd.get()) == 0 && fd.close() &&
                       ::rename(temporary.c_str(), path.c_str()) == 0;
  if (!written) {
    const int code = errno;
    ::unlink(temporary.c_str());
    fail("Cannot write {}: {}.", path.string(), reason(code));
  }
  sync_folder(path);
}

void append_to_file(const fs::path& path, std::string_view bytes) {
  const Descriptor fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  if (fd.get() < 0 || !write_all(fd.get(), bytes)) fail("Cannot write {}: {}.", path.string(), reason(errno));
}

}  // namespace cei3d
