// SPDX-License-Identifier: Apache-2.0
// Threads. Work is cut into chunks whose borders do not depend on the number of threads, so neither do
// results.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <type_traits>
#include <utility>

namespace cei3d {

// Calls body(chunk) for chunk in [0, chunks), in any order, on the threads of the Threads object whose run()
// is active on the calling thread; without one, on all cores.
void parallel_for(int chunks, const std::function<void(int)>& body);

// Calls body(begin, end) on consecutive ranges of [0, n) of `grain` items (the last may be shorter).
void parallel_ranges(int n, int grain, const std::function<void(int, int)>& body);

// A number of threads to work with. Several such objects may be used at the same time, by different threads.
class Threads {
 public:
  explicit Threads(int n = 0);  // 0: one for each core
  ~Threads();
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

  // Calls work(); what it does in parallel, it does on these threads. Returns what work returns and throws
  // what it throws.
  template <class F>
  auto run(F work) const {
    using Result = std::invoke_result_t<F>;
    if constexpr (std::is_void_v<Result>) {
      enter(work);
    } else {
      std::optional<Result> result;
      enter([&] { result.emplace(work()); });
      return std::move(*result);
    }
  }

 private:
  struct Arena;
  void enter(const std::function<void()>& work) const;
  std::unique_ptr<Arena> arena_;
};

}  // namespace cei3d
