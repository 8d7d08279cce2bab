// SPDX-License-Identifier: Apache-2.0
// The one exception type of the program and its kinds. Thrown anywhere. The apps and the workers of catalogs
// make of it what users see; on the way there it is caught to add to what it says, to save or clean up what
// was begun, and where the work goes on without what failed.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>

namespace cei3d {

// Values are the program's exit codes. again: nothing is wrong with the input, the same command may succeed
// later.
enum class ErrorCode { failed = 1, usage = 2, again = 75, interrupted = 130 };

class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& what, std::string hint = {})
      : std::runtime_error(what), code_(code), hint_(std::move(hint)) {}
  ErrorCode code() const { return code_; }
  const std::string& hint() const { return hint_; }  // what the user can do about it; may be empty

 private:
  ErrorCode code_;
  std::string hint_;
};

// The machine is in the way, not the input: a full disk, a file system that is gone. Exit code 1.
class MachineError : public Error {
 public:
  explicit MachineError(const std::string& what) : Error(ErrorCode::failed, what) {}
};

// fail("{} is a truncated PNG. Copy it again.", path): bad data or a failed operation, exit code 1.
template <class... A>
[[noreturn]] void fail(fmt::format_string<A...> text, A&&... args) {
  throw Error(ErrorCode::failed, fmt::format(text, std::forward<A>(args)...));
}

// Wrong use of the program (unknown name, impossible option), exit code 2.
template <class... A>
[[noreturn]] void fail_usage(fmt::format_string<A...> text, A&&... args) {
  throw Error(ErrorCode::usage, fmt::format(text, std::forward<A>(args)...));
}

}  // namespace cei3d
