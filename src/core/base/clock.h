// SPDX-License-Identifier: Apache-2.0
// Time as an argument, so that tests can run schedules on a clock of their own.
#pragma once

#include <chrono>
#include <functional>

namespace cei3d {

// Seconds since some fixed moment; never decreases.
using Clock = std::function<double()>;

// The machine's own clock.
inline double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace cei3d
