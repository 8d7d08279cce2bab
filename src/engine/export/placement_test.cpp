// SPDX-License-Identifier: Apache-2.0
#include "engine/export/placement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace cei3d {
namespace {

TEST(Placement, UpBecomesY) {
  for (const Vec3d up : {Vec3d{0, 0, 1}, Vec3d{0, 1, 0}, Vec3d{0, -1, 0}, Vec3d{-1, 0, 0}, Vec3d{1, 2, -2}}) {
    const Placement p = upright(up);
    EXPECT_NEAR(length(p.turned(normalize(up)) - Vec3d{0, 1, 0}), 0, 1e-9);
    EXPECT_NEAR(length(p(Vec3d{1, 2, 3})), length(Vec3d{1, 2, 3}), 1e-9);
  }
}

TEST(Placement, AtTheBaseTheObjectStandsInTheOriginAndIsAsLargeAsWished) {
  const std::vector<Vec3f> box{{3, 1, 5}, {5, 2, 9}, {3, 2, 5}};
  const Placement p = placement_of(box, {0, 0, 1}, {Origin::base, 1, 0.3});
  std::vector<double> x, y, z;
  for (const Vec3f& point : box) {
    const Vec3d q = p(to_double(point));
    x.push_back(q.x), y.push_back(q.y), z.push_back(q.z);
  }
  const auto [x0, x1] = std::minmax_element(x.begin(), x.end());
  const auto [y0, y1] = std::minmax_element(y.begin(), y.end());
  const auto [z0, z1] = std::minmax_element(z.begin(), z.end());
  EXPECT_NEAR(*x0 + *x1, 0, 1e-9);
  EXPECT_NEAR(*z0 + *z1, 0, 1e-9);
  EXPECT_NEAR(*y0, 0, 1e-9);
  EXPECT_NEAR(*y1, 0.3, 1e-9);  // 4 units high along z
}

TEST(Placement, InTheInputsFrameOnlyTheUnitChanges) {
  const std::vector<Vec3f> points{{3, 1, 5}};
  EXPECT_EQ(placement_of(points, {0, 1, 0}, {}), Placement());
  EXPECT_NEAR(length(placement_of(points, {0, 1, 0}, {Origin::input, 0.01, 0})(Vec3d{3, 1, 5}) -
                     Vec3d{0.03, 0.01, 0.05}),
              0, 1e-12);
}

}  // namespace
}  // namespace cei3d
