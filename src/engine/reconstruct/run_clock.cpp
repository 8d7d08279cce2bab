// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/run_clock.h"

#include <algorithm>
#include <limits>

namespace cei3d {

namespace {

constexpr double kMaxFraction = 0.99;  // reported before the end of a run, however late

std::string message_of(const std::string& stage, const ProgressReport& r) {
  if (r.stage.empty() || r.stage == stage) return r.message;
  return r.message.empty() ? r.stage : r.stage + ", " + r.message;
}

}  // namespace

RunClock::RunClock(Progress& to, Clock clock, double seconds)
    : to_(to), clock_(std::move(clock)), seconds_(seconds), start_(clock_()) {}

void RunClock::resume_at(double elapsed) { start_ = now() - elapsed; }

double RunClock::left() const {
  return seconds_ > 0 ? seconds_ - elapsed() : std::numeric_limits<double>::infinity();
}

void RunClock::enter(std::string stage, double begin, double end) {
  stage_ = std::move(stage);
  begin_ = begin;
  end_ = end;
  report({stage_, 0, -1, ""});
}

void RunClock::on_report(const ProgressReport& r) {
  ProgressReport whole{stage_, begin_ + (end_ - begin_) * std::clamp(r.fraction, 0.0, 1.0), -1,
                       message_of(stage_, r)};
  if (seconds_ > 0) {
    const double seconds_left = left();
    whole.fraction = 1 - seconds_left / seconds_;
    whole.seconds_left = seconds_left > 0 ? seconds_left : -1;
  }
  max_fraction_ = whole.fraction = std::clamp(whole.fraction, max_fraction_, kMaxFraction);
  to_.report(whole);
}

}  // namespace cei3d
