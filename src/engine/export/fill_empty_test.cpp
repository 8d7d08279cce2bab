// SPDX-License-Identifier: Apache-2.0
#include "engine/export/fill_empty.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

TEST(FillEmpty, KeepsWhatIsKnownAndFillsTheRestFromNearby) {
  Image image(37, 20, 2);
  Area known(37 * 20, 0);
  const auto set = [&](int x, int y, float a, float b) {
    image.at(x, y)[0] = a, image.at(x, y)[1] = b;
    known[size_t(y) * 37 + x] = 1;
  };
  for (int y = 4; y < 12; ++y)
    for (int x = 3; x < 11; ++x) set(x, y, 1, 5);
  set(35, 18, 9, -1);
  fill_empty(image, known);
  EXPECT_EQ(image.at(5, 5)[0], 1);
  EXPECT_EQ(image.at(35, 18)[0], 9);
  EXPECT_EQ(image.at(2, 4)[0], 1);  // beside the block
  EXPECT_EQ(image.at(2, 4)[1], 5);
  EXPECT_EQ(image.at(34, 19)[1], -1);  // beside the single texel
  for (const float v : image.data) EXPECT_NE(v, 0);
}

TEST(FillEmpty, NothingKnownStaysAsItIs) {
  Image image(8, 8, 1, 3);
  fill_empty(image, Area(64, 0));
  EXPECT_EQ(image.data, std::vector<float>(64, 3.0f));
}

}  // namespace
}  // namespace cei3d
