// SPDX-License-Identifier: Apache-2.0
#include "core/compute/planes.h"

#include <gtest/gtest.h>

namespace cei3d {
namespace {

TEST(Planes, HoldOneComponentAfterTheOther) {
  const std::vector<Vec3f> v{{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(planes_of(v, 4), (std::vector<float>{1, 4, 0, 0, 2, 5, 0, 0, 3, 6, 0, 0}));
  EXPECT_EQ(planes_of({}, 2), std::vector<float>(6, 0.0f));
}

TEST(Planes, GiveBackTheVectorsInThem) {
  const std::vector<Vec3f> v{{0.5f, -2, 1e-30f}, {4, 5, 6}, {-7, 8, -9}};
  const std::vector<Vec3f> back = vectors_of(planes_of(v, 5), 5, v.size());
  ASSERT_EQ(back.size(), v.size());
  for (size_t i = 0; i < v.size(); ++i)
    for (int c = 0; c < 3; ++c) EXPECT_EQ(back[i][c], v[i][c]) << i;
  EXPECT_TRUE(vectors_of(planes_of(v, 5), 5, 0).empty());
}

}  // namespace
}  // namespace cei3d
