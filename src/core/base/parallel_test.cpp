// SPDX-License-Identifier: Apache-2.0
#include "core/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace cei3d {
namespace {

// Threads that take part in a loop which takes a while.
size_t threads_used() {
  std::mutex mutex;
  std::set<std::thread::id> ids;
  parallel_for(64, [&](int) {
    std::this_thread::sleep_for(std::chrono::microseconds(300));
    const std::lock_guard lock(mutex);
    ids.insert(std::this_thread::get_id());
  });
  return ids.size();
}

TEST(Threads, OneIsTheCallerAlone) {
  const Threads one(1);
  EXPECT_EQ(one.run(threads_used), 1u);
  const auto caller = std::this_thread::get_id();
  one.run([&] { parallel_for(8, [&](int) { EXPECT_EQ(std::this_thread::get_id(), caller); }); });
}

TEST(Threads, ResultsAndErrorsComeThrough) {
  const Threads two(2);
  EXPECT_EQ(two.run([] { return std::string("text"); }), "text");
  EXPECT_THROW(two.run([] { parallel_for(4, [](int) { throw std::runtime_error("in a chunk"); }); }),
               std::runtime_error);
}

// Two of them in two threads: neither limits the other, and every chunk runs once.
TEST(Threads, AreIndependentOfEachOther) {
  const Threads one(1), many(0);
  std::vector<std::atomic<int>> runs(200);
  std::thread other([&] {
    one.run([&] {
      EXPECT_EQ(threads_used(), 1u);
      parallel_for(100, [&](int i) { ++runs[size_t(i)]; });
    });
  });
  many.run([&] { parallel_for(100, [&](int i) { ++runs[size_t(100 + i)]; }); });
  other.join();
  for (const auto& r : runs) EXPECT_EQ(r.load(), 1);
}

}  // namespace
}  // namespace cei3d
