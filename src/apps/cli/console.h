// SPDX-License-Identifier: Apache-2.0
// Output of the program: results on standard output, progress and messages on standard error. For one thread.
#pragma once

#include <chrono>
#include <iosfwd>
#include <string>

#include "core/base/json_fwd.h"
#include "core/base/progress.h"
#include "core/base/time_left.h"

namespace cei3d {

enum class LogLevel { error, warn, info, debug };

// answer(), done(), say(), warn() and error() may be called only by the thread that made the object, while no
// work runs.
class Console : public Progress {
 public:
  Console(std::ostream& out, std::ostream& err, bool err_is_terminal)
      : out_(out), err_(err), terminal_(err_is_terminal) {}

  void set_level(LogLevel level) { level_ = level; }
  void set_json(bool json) { json_ = json; }

  // The result of a query, printed always. text may have several lines.
  void answer(const Json& json, const std::string& text);
  // The result of an action, not printed with --quiet.
  void done(const Json& json, const std::string& text);
  // A line for people: not printed with --quiet or --json.
  void say(const std::string& text);
  void warn(const std::string& text);
  // With --json also prints an object on standard output, unless an answer was printed before.
  void error(const std::string& text, const std::string& hint, int code);

 private:
  void on_report(const ProgressReport&) override;
  void on_log(const std::string& json_line) override;
  bool is_cancelled() const override;

  using Clock = std::chrono::steady_clock;
  void draw_bar(const ProgressReport&, double seconds_left);
  void print_line(const ProgressReport&, double seconds_left);
  void clear_bar();

  std::ostream &out_, &err_;
  bool terminal_, json_ = false, answered_ = false, bar_drawn_ = false;
  LogLevel level_ = LogLevel::info;
  std::string stage_;
  Clock::time_point start_ = Clock::now(), last_{};
  TimeLeft time_left_;
};

}  // namespace cei3d
