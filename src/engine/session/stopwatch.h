// SPDX-License-Identifier: Apache-2.0
// Times of the steps of a command.
#pragma once

#include <chrono>

namespace cei3d {

class Stopwatch {
 public:
  double lap() {  // seconds since the last one
    const auto now = Clock::now();
    const double s = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return s;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace cei3d
