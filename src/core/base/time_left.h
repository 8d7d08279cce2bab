// SPDX-License-Identifier: Apache-2.0
// How long a job still takes, by how far it came so far.
#pragma once

namespace cei3d {

class TimeLeft {
 public:
  // fraction: of the whole job, in ascending order; seconds: now, on any clock. Returns seconds; negative:
  // not known yet. A job that is resumed leaps to where it was: only what comes after its first leap counts.
  double after(double fraction, double seconds) {
    constexpr double kLeap = 0.05, kEnough = 0.02;
    const bool leaps = !leapt_ && fraction - last_ > kLeap;
    if (leaps || first_seconds_ < 0) first_ = fraction, first_seconds_ = seconds;
    leapt_ = leapt_ || leaps;
    last_ = fraction;
    const double gained = fraction - first_;
    return gained < kEnough ? -1 : (seconds - first_seconds_) * (1 - fraction) / gained;
  }

 private:
  double last_ = 0, first_ = 0, first_seconds_ = -1;
  bool leapt_ = false;
};

}  // namespace cei3d
