// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/moved_part.h"

#include <gmock/gmock.h>

#include <cmath>

#include "core/base/error.h"
#include "engine/capture/doctor.h"
#include "engine/capture/test_moved.h"

namespace cei3d {
namespace {

constexpr int kSize = 72;

SmallMasks masks_of(int before, int after, Ball moved = kMovedKnob) {
  return moved_masks(before, after, kSize, moved);
}
// A silhouette of one position may fit the hull of the views of the other, which are few.
constexpr size_t kUncertain = 2;  // views

TEST(MovedPart, IsFoundWithTheTimeOfItsMoveAndThePositionOfMostViews) {
  for (const auto& [before, after] : {std::pair{26, 17}, {15, 30}}) {
    const std::optional<MovedPart> part = find_moved_part(masks_of(before, after));
    ASSERT_TRUE(part.has_value()) << before;
    EXPECT_NEAR(double(part->first), before, kUncertain);
    EXPECT_EQ(part->shown_by_most(0), before > after) << before;
    EXPECT_EQ(part->shown_by_most(size_t(before)), before < after) << before;
  }
}

// What sticks out of the body in one position and not in the other lies in the place, and little else does.
TEST(MovedPart, ItsPlaceHoldsWhatMoved) {
  const SmallMasks masks = masks_of(26, 17);
  const std::optional<MovedPart> part = find_moved_part(masks);
  ASSERT_TRUE(part.has_value());
  for (const Camera& camera : masks.cameras) {
    const Ball both[] = {kKnob, kMovedKnob};
    const Area place = seen_hull(part->place, camera), changed = changed_pixels(camera);
    if (pixels_in(changed) > 0) {
      EXPECT_GT(share_of(place, changed), 0.95);
    }
    EXPECT_GT(share_of(dilated(seen_balls(both, camera), kSize, kSize, 4), place), 0.95);
  }
}

TEST(MovedPart, ThereIsNoneWhereMasksAgree) {
  EXPECT_FALSE(find_moved_part(masks_of(26, 17, kKnob)).has_value());
}

// Some wrong masks are not a move.
TEST(MovedPart, ThereIsNoneWhereSomeMasksAreWrong) {
  SmallMasks masks = masks_of(26, 17, kKnob);
  for (const size_t view : {3, 11, 20, 33, 40})
    for (size_t i = 0; i < masks.masks[view].size() / 3; ++i) masks.masks[view][i] = kObject;
  EXPECT_FALSE(find_moved_part(masks).has_value());
}

// Views in any order; the numbers in their names say when they were taken.
TEST(MovedPart, IsReportedByNameAndLeftOutOfTheFewerViews) {
  const SmallMasks masks = masks_of(26, 17);
  const size_t n = masks.masks.size();
  std::vector<View> views(n);
  std::vector<JudgedMask> judged;
  for (size_t k = 0; k < n; ++k) {
    const size_t i = k * 5 % n;
    views[i].name = fmt::format("img_{}", i + 1);
    views[i].camera = masks.cameras[i];
    judged.push_back({&views[i], masks.masks[i]});
  }
  std::vector<Finding> findings;
  const std::vector<Area> unsure = check_moves(judged, Normalization(), findings);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_THAT(findings[0].what, testing::MatchesRegex(".*moved between img_2[456] and img_2[567]:.*"));
  for (size_t k = 0; k < n; ++k) {
    const size_t i = k * 5 % n;
    if (i >= 26 - kUncertain && i < 26) continue;
    EXPECT_EQ(unsure[k].empty(), i < 26) << judged[k].view->name;
  }
}

TEST(SeenHull, OfACubeIsItsSilhouette) {
  const Camera camera = spread_cameras(5, lens_of_size(kSize, kSize))[3];
  std::vector<Vec3d> corners;
  for (const double x : {-0.3, 0.3})
    for (const double y : {-0.3, 0.3})
      for (const double z : {-0.3, 0.3}) corners.push_back({x, y, z});
  const Area hull = seen_hull(corners, camera);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const Ray ray = camera.ray(x + 0.5, y + 0.5);
      double first = 0, last = 1e9;  // where the ray is between the planes of opposite faces
      for (int k = 0; k < 3; ++k) {
        const double a = (-0.3 - ray.origin[k]) / ray.direction[k],
                     b = (0.3 - ray.origin[k]) / ray.direction[k];
        first = std::max(first, std::min(a, b)), last = std::min(last, std::max(a, b));
      }
      if (std::abs(first - last) < 1e-3) continue;
      EXPECT_EQ(hull[size_t(y) * kSize + size_t(x)] != 0, first < last) << x << " " << y;
    }
}

}  // namespace
}  // namespace cei3d
