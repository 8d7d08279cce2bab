// SPDX-License-Identifier: Apache-2.0
#include "core/base/run_list.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace cei3d {
namespace {

template <class T>
RunList<T> list_of(const std::vector<T>& values) {
  RunList<T> list;
  for (const T& v : values) list.push_back(v);
  list.shrink_to_fit();
  return list;
}

template <class T>
std::vector<T> elements(const RunList<T>& list) {
  typename RunList<T>::Reader reader(list);
  std::vector<T> values;
  for (size_t k = 0; k < list.size(); ++k) values.push_back(reader.next());
  return values;
}

TEST(RunList, IsReadAsItWasWritten) {
  std::mt19937 random(1);
  for (const int kinds : {1, 2, 5, 1000}) {
    std::vector<int> values;
    for (int i = 0; i < 500; ++i) values.push_back(int(random() % unsigned(kinds)));
    EXPECT_EQ(elements(list_of(values)), values) << kinds;
  }
  EXPECT_EQ(RunList<int>().size(), 0u);
}

TEST(RunList, RunsTakeTheRoomOfOneElement) {
  EXPECT_EQ(list_of(std::vector<int>(1000, 7)).bytes(), list_of(std::vector<int>{7}).bytes());
  EXPECT_EQ(list_of(std::vector<int>{1, 1, 2, 2, 2, 1}).bytes(), 3 * list_of(std::vector<int>{7}).bytes());
}

// Zeros of both signs are equal, and NaN is not equal to itself.
TEST(RunList, BitsDecide) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const RunList<float> list = list_of<float>({0.0f, -0.0f, nan, nan});
  EXPECT_EQ(list.bytes(), 3 * list_of<float>({1}).bytes());
  EXPECT_TRUE(std::signbit(elements(list)[1]));
}

}  // namespace
}  // namespace cei3d
