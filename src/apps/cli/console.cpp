// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/console.h"

#include <algorithm>
#include <cctype>
#include <ostream>

#include "apps/cli/interrupt.h"
#include "apps/cli/parse.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

constexpr int kBarWidth = 24;
constexpr double kRedrawSeconds = 0.1, kLineSeconds = 10;
constexpr double kQuietStart = 2;  // seconds without progress lines: short commands print none

std::string bar(double fraction) {
  const int full = std::clamp(int(fraction * kBarWidth + 0.5), 0, kBarWidth);
  return std::string(size_t(full), '#') + std::string(size_t(kBarWidth - full), '.');
}

// The text as a sentence, with a full stop; follows: after another sentence.
std::string sentence(std::string text, bool follows) {
  if (text.empty()) return text;
  if (follows) text[0] = char(std::toupper(static_cast<unsigned char>(text[0])));
  if (std::string(".!?").find(text.back()) == std::string::npos) text += '.';
  return follows ? " " + text : text;
}

std::string left(double seconds) { return seconds < 0 ? std::string() : duration_text(seconds) + " left"; }

}  // namespace

void Console::answer(const Json& json, const std::string& text) {
  clear_bar();
  answered_ = true;
  if (json_)
    out_ << json.dump(1) << '\n';
  else
    out_ << text << (text.empty() || text.back() == '\n' ? "" : "\n");
  out_.flush();
}

void Console::done(const Json& json, const std::string& text) {
  if (json_ || level_ >= LogLevel::info) answer(json, text);
}

void Console::say(const std::string& text) {
  if (!json_ && level_ >= LogLevel::info) out_ << text << std::endl;
}

void Console::warn(const std::string& text) {
  clear_bar();
  if (level_ >= LogLevel::warn) err_ << "warning: " << text << '\n';
}

void Console::error(const std::string& text, const std::string& hint, int code) {
  clear_bar();
  err_ << "error: " << sentence(text, false) << sentence(hint, true) << '\n';
  if (json_ && !answered_) out_ << Json{{"error", text}, {"exit_code", code}}.dump(1) << '\n';
  out_.flush();
  err_.flush();
}

void Console::on_report(const ProgressReport& r) {
  if (level_ < LogLevel::info) return;
  const Clock::time_point now = Clock::now();
  const auto since = [&](Clock::time_point t) { return std::chrono::duration<double>(now - t).count(); };
  const double by_progress = time_left_.after(r.fraction, since(start_));
  const bool new_stage = r.stage != stage_;
  if (!terminal_ && since(start_) < kQuietStart) return;
  if (!new_stage && r.fraction < 1 && since(last_) < (terminal_ ? kRedrawSeconds : kLineSeconds)) return;
  last_ = now;
  stage_ = r.stage;
  const double seconds_left = r.seconds_left < 0 ? by_progress : r.seconds_left;
  if (terminal_)
    draw_bar(r, seconds_left);
  else
    print_line(r, seconds_left);
}

void Console::draw_bar(const ProgressReport& r, double seconds_left) {
  err_ << fmt::format("\r\x1b[K{:<11}[{}] {:3.0f}%  {}  {}", r.stage, bar(r.fraction), 100 * r.fraction,
                      left(seconds_left), r.message)
       << std::flush;
  bar_drawn_ = true;
}

void Console::print_line(const ProgressReport& r, double seconds_left) {
  std::string line = fmt::format("{}: {:.0f}%", r.stage, 100 * r.fraction);
  for (const std::string& part : {left(seconds_left), r.message})
    if (!part.empty()) line += ", " + part;
  err_ << line << std::endl;
}

void Console::clear_bar() {
  if (bar_drawn_) err_ << "\r\x1b[K" << std::flush;
  bar_drawn_ = false;
}

void Console::on_log(const std::string& json_line) {
  if (level_ < LogLevel::debug) return;
  clear_bar();
  err_ << json_line << '\n';
}

bool Console::is_cancelled() const { return interrupted(); }

}  // namespace cei3d
