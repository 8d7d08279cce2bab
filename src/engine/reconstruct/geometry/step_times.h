// SPDX-License-Identifier: Apache-2.0
// The processor time of the parts of training steps, for `cei3d bench`. Processor time is less disturbed by
// other programs than wall time.
#pragma once

#include <time.h>

#include <array>
#include <atomic>

namespace cei3d {

enum class StepPart { occupancy, march, forward, backward, scatter, adam };
inline constexpr int kStepParts = 6;

class StepTimes {
 public:
  // Runs fn, which stays on the calling thread; others may do the same at the same time. times may be null.
  template <class F>
  static void thread(StepTimes* times, StepPart part, F fn) {
    run(times, part, CLOCK_THREAD_CPUTIME_ID, fn);
  }
  // Runs fn, which may use all threads; nothing else runs in this process.
  template <class F>
  static void process(StepTimes* times, StepPart part, F fn) {
    run(times, part, CLOCK_PROCESS_CPUTIME_ID, fn);
  }

  double seconds(StepPart part) const { return 1e-9 * double(nanoseconds_[size_t(part)].load()); }
  void clear() {
    for (auto& n : nanoseconds_) n = 0;
  }
  static double process_seconds() { return 1e-9 * double(now(CLOCK_PROCESS_CPUTIME_ID)); }

 private:
  static int64_t now(clockid_t clock) {
    timespec t{};
    ::clock_gettime(clock, &t);
    return int64_t(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
  }
  template <class F>
  static void run(StepTimes* times, StepPart part, clockid_t clock, F& fn) {
    if (!times) return fn();
    const int64_t begin = now(clock);
    fn();
    times->nanoseconds_[size_t(part)] += now(clock) - begin;
  }
  std::array<std::atomic<int64_t>, kStepParts> nanoseconds_{};
};

}  // namespace cei3d
