// SPDX-License-Identifier: Apache-2.0
#include "core/base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <memory>
#include <vector>

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

// Whether the same file may be written or read when the machine is in order again.
bool may_pass(int code) {
  for (const int passing :
       {ENOSPC, EDQUOT, EIO, ESTALE, ENOTCONN, ENODEV, ETIMEDOUT, EHOSTDOWN, ENOMEM, EROFS})
    if (code == passing) return true;
  return false;
}

[[noreturn]] void fail_file(const char* what, const fs::path& path, int code) {
  const std::string text = fmt::format("Cannot {} {}: {}.", what, path.string(), reason(code));
  if (may_pass(code)) throw MachineError(text);
  throw Error(ErrorCode::failed, text);
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
  if (error) fail_file("make folder", path.parent_path(), error.value());
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

// A file beside its target, removed unless it has taken the target's name.
class Temporary {
 public:
  explicit Temporary(const fs::path& target) : target_(target) {
    make_parent(target);
    path_ = temporary_name(target);
  }
  ~Temporary() {
    if (!renamed_) ::unlink(path_.c_str());
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;

  void write(std::string_view bytes) {
    Descriptor fd(::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    require(fd.get() >= 0 && write_all(fd.get(), bytes) && ::fsync(fd.get()) == 0 && fd.close());
  }
  void rename() {
    require(::rename(path_.c_str(), target_.c_str()) == 0);
    renamed_ = true;
    sync_folder(target_);
  }

 private:
  void require(bool done) const {
    if (!done) fail_file("write", target_, errno);
  }

  fs::path target_, path_;
  bool renamed_ = false;
};

}  // namespace

std::string read_file(const fs::path& path) {
  const Descriptor fd(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  struct stat info {};
  if (fd.get() < 0 || ::fstat(fd.get(), &info) != 0) fail_file("read", path, errno);
  if (S_ISDIR(info.st_mode)) fail("Cannot read {}: {}.", path.string(), reason(EISDIR));
  // +1: sees the end at once.
  std::string bytes(S_ISREG(info.st_mode) ? size_t(info.st_size) + 1 : 65536, '\0');
  size_t used = 0;
  while (true) {  // to the end, not to st_size: pipes and growing files
    if (used == bytes.size()) bytes.resize(2 * used);
    const ssize_t n = ::read(fd.get(), bytes.data() + used, bytes.size() - used);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail_file("read", path, errno);
    if (n == 0) break;
    used += size_t(n);
  }
  bytes.resize(used);
  return bytes;
}

void write_file_atomic(const fs::path& path, std::string_view bytes) {
  Temporary file(path);
  file.write(bytes);
  file.rename();
}

void write_files_atomic(std::span<const FileBytes> files) {
  std::vector<std::unique_ptr<Temporary>> written;
  for (const FileBytes& f : files) {
    written.push_back(std::make_unique<Temporary>(f.path));
    written.back()->write(f.bytes);
  }
  for (const auto& file : written) file->rename();
}

void require_writable(const fs::path& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) fail("Cannot write {}: {}.", path.string(), reason(EISDIR));
  fs::path folder = fs::absolute(path).parent_path();
  while (!fs::exists(folder, error) && folder.has_relative_path()) folder = folder.parent_path();
  if (!fs::is_directory(folder, error))
    fail("Cannot write {}: {} is not a folder.", path.string(), folder.string());
  if (::access(folder.c_str(), W_OK) != 0) fail("Cannot write {}: {}.", path.string(), reason(errno));
}

void append_to_file(const fs::path& path, std::string_view bytes) {
  const Descriptor fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666));
  if (fd.get() < 0 || !write_all(fd.get(), bytes)) fail_file("write", path, errno);
}

bool write_new_file(const fs::path& path, std::string_view bytes) {
  Descriptor fd(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (fd.get() < 0 && errno == EEXIST) return false;
  if (fd.get() < 0) fail_file("write", path, errno);
  if (write_all(fd.get(), bytes) && ::fsync(fd.get()) == 0 && fd.close()) return true;
  const int code = errno;
  ::unlink(path.c_str());
  fail_file("write", path, code);
}

bool touch_file(const fs::path& path) { return ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0) == 0; }

void move_path(const fs::path& from, const fs::path& to) {
  if (::rename(from.c_str(), to.c_str()) != 0) fail_file("write", to, errno);
  sync_folder(to);
}

}  // namespace cei3d
