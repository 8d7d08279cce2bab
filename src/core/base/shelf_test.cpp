// SPDX-License-Identifier: Apache-2.0
#include "core/base/shelf.h"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

#include "core/base/error.h"

namespace cei3d {
namespace {

// Numbers on a shelf, 10 bytes each, that count how often they are read.
struct Numbers {
  std::shared_ptr<Shelf> shelf = std::make_shared<Shelf>(30);
  std::shared_ptr<std::vector<int>> reads = std::make_shared<std::vector<int>>(10, 0);

  Shelved<int> make(int i) const {
    const auto read = [reads = reads, i]() -> std::shared_ptr<const int> {
      ++(*reads)[size_t(i)];
      return std::make_shared<int>(i);
    };
    return {shelf, std::to_string(i), 10, std::make_shared<const int>(i), read};
  }
};

TEST(Shelf, DropsWhatWasNotUsedAndReadsItAgain) {
  const Numbers numbers;
  std::vector<Shelved<int>> all;
  for (int i = 0; i < 5; ++i) {
    all.push_back(numbers.make(i));
    all[0].use();  // so that it is never dropped
  }
  EXPECT_EQ(numbers.shelf->bytes(), 30u);
  EXPECT_EQ(numbers.shelf->reads(), 0u);
  EXPECT_EQ(*all[0].use(), 0);
  EXPECT_EQ((*numbers.reads)[0], 0);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(*all[size_t(i)].use(), i);
  EXPECT_GE(numbers.shelf->reads(), 2u);
  EXPECT_EQ(numbers.shelf->bytes(), 30u);
}

TEST(Shelf, ALowerLimitHoldsAtOnce) {
  const Numbers numbers;
  const Shelved<int> a = numbers.make(0), b = numbers.make(1), c = numbers.make(2);
  EXPECT_EQ(numbers.shelf->bytes(), 30u);
  numbers.shelf->limit(20);
  EXPECT_EQ(numbers.shelf->bytes(), 20u);
  EXPECT_EQ(*a.use() + *b.use() + *c.use(), 3);
  EXPECT_EQ(numbers.shelf->bytes(), 20u);
  numbers.shelf->limit(30);
  EXPECT_EQ(*a.use() + *b.use() + *c.use(), 3);
  EXPECT_EQ(numbers.shelf->bytes(), 30u);
}

TEST(Shelf, WhatIsInUseStaysWhereItIs) {
  const Numbers numbers;
  const Shelved<int> first = numbers.make(0);
  const Shelved<int>::Use use = first.use();
  const int* const at = &*use;
  std::vector<Shelved<int>> others;
  for (int i = 1; i < 10; ++i) others.push_back(numbers.make(i));
  EXPECT_EQ(*at, 0);
  EXPECT_LE(numbers.shelf->bytes(), 30u);
}

TEST(Shelf, ForgetsValuesThatAreNotReferenced) {
  const Numbers numbers;
  {
    const Shelved<int> a = numbers.make(0), b = a;
    EXPECT_EQ(numbers.shelf->bytes(), 10u);
  }
  EXPECT_EQ(numbers.shelf->bytes(), 0u);
}

TEST(Shelf, KeepsWhatCannotBeReadAgain) {
  const Numbers numbers;
  const Shelved<int> first = numbers.make(0);
  std::vector<Shelved<int>> others;
  for (int i = 1; i < 10; ++i) others.push_back(numbers.make(i));
  numbers.shelf->keep("0");
  const size_t reads = numbers.shelf->reads();
  for (int round = 0; round < 3; ++round)
    for (const Shelved<int>& other : others) other.use();
  EXPECT_EQ(*first.use(), 0);
  EXPECT_EQ((*numbers.reads)[0], 1);  // for keep()
  EXPECT_GT(numbers.shelf->reads(), reads);
}

TEST(Shelf, ReadingMayFail) {
  const auto shelf = std::make_shared<Shelf>(10);
  const auto read = []() -> std::shared_ptr<const int> { fail("gone"); };
  const Shelved<int> lost(shelf, "lost", 10, std::make_shared<const int>(1), read);
  EXPECT_EQ(*lost.use(), 1);
  const Numbers numbers;
  const Shelved<int> other(shelf, "other", 10, std::make_shared<const int>(2), read);
  const Shelved<int> third(shelf, "third", 10, std::make_shared<const int>(3), read);
  EXPECT_THROW(lost.use(), Error);
  shelf->keep("lost");  // ignores the error
  EXPECT_THROW(lost.use(), Error);
}

TEST(Shelf, ServesManyThreads) {
  const Numbers numbers;
  const auto shelf = std::make_shared<Shelf>(30);
  std::vector<Shelved<int>> all;
  for (int i = 0; i < 8; ++i)
    all.emplace_back(shelf, std::to_string(i), 10, std::make_shared<const int>(i),
                     [i] { return std::make_shared<const int>(i); });
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (int k = 0; k < 5000; ++k) {
        const int i = (k * 5 + t) % 8;
        wrong += *all[size_t(i)].use() != i;
        if (k % 100 == 0) shelf->keep(std::to_string(t));
      }
    });
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(wrong, 0);
}

TEST(Shelved, HoldsAValueInMemory) {
  const Shelved<int> none, null = nullptr, seven = std::make_shared<int>(7);
  EXPECT_FALSE(none || null);
  EXPECT_TRUE(seven);
  EXPECT_EQ(*seven.use(), 7);
  EXPECT_EQ(*seven.share(), 7);
}

}  // namespace
}  // namespace cei3d
