// SPDX-License-Identifier: Apache-2.0
#include "core/math/axis_box.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace cei3d {
namespace {

using Points = std::vector<Vec3f>;

TEST(AxisBox, HoldsWhatWasAddedAndWhatIsBetween) {
  const AxisBox box = box_of(Points{{1, 5, -2}, {3, 4, 0}});
  for (const Vec3f p : {Vec3f{1, 5, -2}, {3, 4, 0}, {2, 4.5f, -1}, {1, 4, 0}}) EXPECT_TRUE(box.contains(p));
  for (const Vec3f p : {Vec3f{0.9f, 4.5f, -1}, {2, 5.1f, -1}, {2, 4.5f, 0.1f}, {NAN, 4.5f, -1}})
    EXPECT_FALSE(box.contains(p));
}

TEST(AxisBox, MeetsWhatHasAPointInCommon) {
  const AxisBox box = box_of(Points{{0, 0, 0}, {2, 2, 2}});
  for (int axis = 0; axis < 3; ++axis)
    for (const float at : {-3.0f, -1.0f, 0.5f, 2.0f, 2.5f}) {
      Vec3f a{0.5f, 0.5f, 0.5f}, b{1.5f, 1.5f, 1.5f};
      a[axis] = at;
      b[axis] = at + 1;
      EXPECT_EQ(box.meets(box_of(Points{a, b})), at >= -1 && at <= 2) << axis << ' ' << at;
    }
}

TEST(AxisBox, HasTheSizeOfItsPoints) {
  const Vec3d size = box_of(std::vector<Vec3d>{{1, 2, 3}, {1.5, -2, 3}, {0, 0, 3}}).size();
  EXPECT_EQ(size.x, 1.5);
  EXPECT_EQ(size.y, 4);
  EXPECT_EQ(size.z, 0);
}

TEST(AxisBox, AnEmptyOneMeetsNothing) {
  EXPECT_FALSE(AxisBox().meets(box_of(Points{{-9, -9, -9}, {9, 9, 9}})));
  EXPECT_FALSE(AxisBox().contains({0, 0, 0}));
}

TEST(AxisBox, LeavesOutWhatIsNotANumber) {
  EXPECT_TRUE(box_of(Points{{NAN, 0, 0}, {1, 1, 1}, {0, NAN, NAN}}).contains({0.5f, 0.5f, 1}));
}

}  // namespace
}  // namespace cei3d
