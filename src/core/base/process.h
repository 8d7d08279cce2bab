// SPDX-License-Identifier: Apache-2.0
// Other processes of this machine.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cei3d {

// A process among all that a machine ever ran until it is switched off.
struct ProcessId {
  std::string space;  // of process numbers: the machine, since when it runs, its container
  int pid = 0;
  uint64_t started = 0;  // ticks since the machine's start
};
ProcessId this_process();
// None: the process belongs to another space, so that nothing is known here.
std::optional<bool> is_running(const ProcessId&);

// A program that runs beside this one. It is asked to stop (SIGTERM) when this program ends, however it ends.
class Child {
 public:
  // output: file that what it prints is appended to. Error: it cannot be started.
  Child(const std::vector<std::string>& command, const std::filesystem::path& output);
  ~Child();  // waits for it
  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;

  std::optional<int> exit_code();  // none: it still runs; 128 + signal when a signal ended it
  void ask_to_stop();              // SIGTERM
  int pid() const { return pid_; }

 private:
  int pid_ = -1;
  std::optional<int> code_;
};

struct ProgramOutput {
  int exit_code = 0;
  std::string text;  // standard output and standard error
};
// Runs a program to its end. Error: it cannot be started.
ProgramOutput run_program(const std::vector<std::string>& command);

}  // namespace cei3d
