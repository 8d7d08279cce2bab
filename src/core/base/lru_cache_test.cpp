// SPDX-License-Identifier: Apache-2.0
#include "core/base/lru_cache.h"

#include <gtest/gtest.h>

#include <deque>
#include <random>

namespace cei3d {
namespace {

TEST(LruCache, RandomUseAgreesWithAList) {
  constexpr size_t kBytes = 40;
  LruCache<int, int> cache(kBytes);
  std::deque<std::pair<int, size_t>> reference;  // key and bytes, the one used last first
  size_t found = 0;
  std::mt19937 random(5);
  for (uint64_t step = 0; step < 2000; ++step) {
    const int key = int(random() % 12);
    const auto it = std::find_if(reference.begin(), reference.end(), [&](auto& e) { return e.first == key; });
    if (const auto value = cache.find(key)) {
      ASSERT_NE(it, reference.end()) << step;
      EXPECT_EQ(*value, 10 * key);
      const auto entry = *it;
      reference.erase(it);
      reference.push_front(entry);
      ++found;
    } else {
      ASSERT_EQ(it, reference.end()) << step;
      const size_t bytes = 1 + random() % 60;
      cache.put(key, std::make_shared<int>(10 * key), bytes);
      reference.emplace_front(key, bytes);
      const auto sum = [&] {
        size_t s = 0;
        for (const auto& e : reference) s += e.second;
        return s;
      };
      while (sum() > kBytes && reference.size() > 1) reference.pop_back();
      EXPECT_EQ(cache.bytes(), sum());
    }
    EXPECT_EQ(cache.size(), reference.size());
  }
  EXPECT_EQ(cache.count().found, found);
  EXPECT_EQ(cache.count().found + cache.count().missed, 2000u);
  EXPECT_GT(found, 100u);
}

TEST(LruCache, AKeyHasOneValue) {
  LruCache<int, int> cache(100);
  cache.put(1, std::make_shared<int>(1), 10);
  const auto old = cache.find(1);
  cache.put(1, std::make_shared<int>(2), 20);
  EXPECT_EQ(*cache.find(1), 2);
  EXPECT_EQ(*old, 1);
  EXPECT_EQ(cache.size(), 1u);
  EXPECT_EQ(cache.bytes(), 20u);
}

}  // namespace
}  // namespace cei3d
