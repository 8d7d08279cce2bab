// SPDX-License-Identifier: Apache-2.0
#include "core/base/system.h"

#include <fcntl.h>
#include <malloc.h>
#include <stdlib.h>
#include <sys/file.h>
#include <sys/resource.h>
#include <sys/sysinfo.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <utility>

#include "core/base/error.h"

// Of jemalloc; null in programs that are not linked with it, such as most tests.
extern "C" int mallctl(const char* name, void* old_value, size_t* old_size, void* new_value, size_t new_size)
    __attribute__((weak));

namespace cei3d {
namespace fs = std::filesystem;
namespace {

double clock_seconds(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

}  // namespace

std::string processor_name() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

double memory_gib() {
  struct sysinfo info {};
  if (::sysinfo(&info) != 0) return 0;
  return double(info.totalram) * info.mem_unit / double(1 << 30);
}

fs::path program_file() {
  std::error_code ignored;
  return fs::read_symlink("/proc/self/exe", ignored);
}

double thread_seconds() { return clock_seconds(CLOCK_THREAD_CPUTIME_ID); }
double process_seconds() { return clock_seconds(CLOCK_PROCESS_CPUTIME_ID); }

double peak_memory_gib() {
  rusage usage{};
  return ::getrusage(RUSAGE_SELF, &usage) == 0 ? double(usage.ru_maxrss) / double(1 << 20) : 0;
}

std::string utc_text(const char* format) {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[64];
  std::strftime(text, sizeof text, format, &utc);
  return text;
}

std::string machine_name() {
  char name[256] = "";
  const bool known = ::gethostname(name, sizeof name - 1) == 0 && name[0] != 0;
  return known ? name : "this-machine";
}

bool has_desktop() { return std::getenv("DISPLAY") != nullptr || std::getenv("WAYLAND_DISPLAY") != nullptr; }

void open_on_desktop(const fs::path& file) {
  if (::fork() != 0) return;
  ::setsid();
  ::execlp("xdg-open", "xdg-open", file.c_str(), static_cast<char*>(nullptr));
  ::_exit(127);
}

fs::path make_temporary_folder() {
  std::string name = (fs::temp_directory_path() / "cei3d-XXXXXX").string();
  if (!::mkdtemp(name.data()))
    fail("Cannot make a temporary folder like {}: {}.", name, std::strerror(errno));
  return name;
}

void give_back_freed_memory() {
  if (mallctl) {
    mallctl("arena.4096.purge", nullptr, nullptr, nullptr, 0);  // 4096: of all arenas
    return;
  }
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
}

std::optional<FileLock> FileLock::take(const fs::path& file) {
  FileLock lock(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  if (lock.descriptor_ < 0) fail("Cannot write {}: {}.", file.string(), std::strerror(errno));
  if (::flock(lock.descriptor_, LOCK_EX | LOCK_NB) == 0) return lock;
  if (errno == EWOULDBLOCK) return std::nullopt;
  fail("Cannot lock {}: {}.", file.string(), std::strerror(errno));
}

bool FileLock::write(const std::string& text) const {
  return ::ftruncate(descriptor_, 0) == 0 &&
         ::pwrite(descriptor_, text.data(), text.size(), 0) == ssize_t(text.size());
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}
FileLock::FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
FileLock& FileLock::operator=(FileLock&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

}  // namespace cei3d
