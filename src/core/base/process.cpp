// SPDX-License-Identifier: Apache-2.0
#include "core/base/process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include "core/base/error.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

std::string first_line(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

// Field 22 of /proc/PID/stat; the name in field 2 may have spaces and brackets. 0: there is no such process,
// or it has ended and waits to be asked for its exit code.
uint64_t start_ticks(int pid) {
  const std::string line = first_line(fmt::format("/proc/{}/stat", pid));
  std::istringstream fields(line.substr(std::min(line.size(), line.rfind(')') + 1)));
  std::string field, state;
  fields >> state;
  constexpr int kBetween = 18;
  for (int i = 0; i < kBetween; ++i) fields >> field;
  uint64_t ticks = 0;
  fields >> ticks;
  return state == "Z" || state == "X" ? 0 : ticks;
}

std::vector<char*> arguments(std::vector<std::string>& command) {
  std::vector<char*> out;
  for (std::string& word : command) out.push_back(word.data());
  out.push_back(nullptr);
  return out;
}

// Starts a program whose output goes to a descriptor; with_parent: it is asked to stop when this program
// ends.
int start(std::vector<std::string> command, int output, bool with_parent) {
  const std::vector<char*> argv = arguments(command);
  const pid_t parent = ::getpid(), pid = ::fork();
  if (pid < 0) throw MachineError(fmt::format("Cannot start {}: {}.", command[0], std::strerror(errno)));
  if (pid > 0) return pid;
  if (with_parent) ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (with_parent && ::getppid() != parent) ::_exit(130);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::execvp(argv[0], argv.data());
  ::_exit(127);
}

int code_of(int status) { return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status); }

}  // namespace

ProcessId this_process() {
  std::error_code ignored;
  const std::string names = fs::read_symlink("/proc/self/ns/pid", ignored).string();
  return {first_line("/proc/sys/kernel/random/boot_id") + " " + names, ::getpid(), start_ticks(::getpid())};
}

std::optional<bool> is_running(const ProcessId& process) {
  if (process.space != this_process().space) return std::nullopt;
  return start_ticks(process.pid) == process.started && process.started != 0;
}

Child::Child(const std::vector<std::string>& command, const fs::path& output) {
  const int fd = ::open(output.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (fd < 0) throw MachineError(fmt::format("Cannot write {}: {}.", output.string(), std::strerror(errno)));
  pid_ = start(command, fd, true);
  ::close(fd);
}

Child::~Child() {
  if (pid_ > 0 && !code_) ::waitpid(pid_, nullptr, 0);
}
Child::Child(Child&& other) noexcept : pid_(std::exchange(other.pid_, -1)), code_(other.code_) {}
Child& Child::operator=(Child&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(code_, other.code_);
  return *this;
}

std::optional<int> Child::exit_code() {
  int status = 0;
  if (!code_ && ::waitpid(pid_, &status, WNOHANG) == pid_) code_ = code_of(status);
  return code_;
}

void Child::ask_to_stop() {
  if (!code_) ::kill(pid_, SIGTERM);
}

ProgramOutput run_program(const std::vector<std::string>& command) {
  int ends[2];
  if (::pipe2(ends, O_CLOEXEC) != 0) throw MachineError(std::strerror(errno));
  const int pid = start(command, ends[1], false);
  ::close(ends[1]);
  ProgramOutput out;
  char buffer[4096];
  for (ssize_t n; (n = ::read(ends[0], buffer, sizeof buffer)) > 0 || (n < 0 && errno == EINTR);)
    if (n > 0) out.text.append(buffer, size_t(n));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(pid, &status, 0);
  out.exit_code = code_of(status);
  constexpr int kNotStarted = 127;
  if (out.exit_code == kNotStarted) fail("Cannot start {}: is it installed?", command[0]);
  return out;
}

}  // namespace cei3d
