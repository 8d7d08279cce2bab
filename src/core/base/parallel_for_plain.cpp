// SPDX-License-Identifier: Apache-2.0
// parallel_for for ThreadSanitizer, in place of parallel_for.cpp (CEI3D_PLAIN_THREADS): ThreadSanitizer does
// not see the synchronization of oneTBB and would report every result as a race. Creating threads for each
// call is slow but is analyzed correctly.
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "core/base/parallel.h"

namespace cei3d {
namespace {

thread_local bool in_parallel = false;  // calls within calls run on their own thread

// Takes chunks until none is left; keeps the first exception.
struct Chunks {
  int count;
  const std::function<void(int)>& body;
  std::atomic<int> next{0};
  std::mutex mutex{};
  std::exception_ptr error{};

  void work() {
    const bool nested = in_parallel;
    in_parallel = true;
    try {
      for (int i = next++; i < count; i = next++) body(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!error) error = std::current_exception();
    }
    in_parallel = nested;
  }
};

}  // namespace

void parallel_for(int chunks, const std::function<void(int)>& body) {
  Chunks all{.count = chunks, .body = body};
  constexpr int kThreads = 3;  // besides this one: more than one even on one core
  std::vector<std::thread> threads;
  for (int k = 0; k < kThreads && k + 1 < chunks && !in_parallel; ++k)
    threads.emplace_back([&] { all.work(); });
  all.work();
  for (std::thread& t : threads) t.join();
  if (all.error) std::rethrow_exception(all.error);
}

}  // namespace cei3d
