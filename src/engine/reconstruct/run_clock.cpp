// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/run_clock.h"

#include <algorithm>
#include <chrono>
#include <limits>

namespace cei3d {

namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

RunClock::RunClock(Progress& to, double seconds) : to_(to), seconds_(seconds), start_(now()) {}

void RunClock::resume_at(double elapsed) { start_ = now() - elapsed; }

double RunClock::elapsed() const { return now() - start_; }

double RunClock::left() const {
  return seconds_ > 0 ? seconds_ - elapsed() : std::numeric_limits<double>::infinity();
}

void RunClock::on_report(const ProgressReport& r) {
  constexpr double kAlmost = 0.99;  // a run that is late is not over
  ProgressReport by_clock = r;
  if (seconds_ > 0 && r.fraction < 1) {
    by_clock.fraction = std::min(elapsed() / seconds_, kAlmost);
    by_clock.seconds_left = left() > 0 ? left() : -1;
  }
  furthest_ = by_clock.fraction = std::max(furthest_, by_clock.fraction);
  to_.report(by_clock);
}

}  // namespace cei3d
