// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/moved_areas.h"

#include <gtest/gtest.h>

#include "engine/capture/test_moved.h"

namespace cei3d {
namespace {

constexpr int kBefore = 40, kAfter = 14, kSize = 160;

std::vector<Vec3d> cube(Vec3d center, double half) {
  std::vector<Vec3d> out;
  for (const double x : {-half, half})
    for (const double y : {-half, half})
      for (const double z : {-half, half}) out.push_back(center + Vec3d{x, y, z});
  return out;
}

// A place that holds only the middle of the knob, as coarse cells may find it.
MovedPart part_of_the_knob() {
  const Vec3d middle = (kKnob.center + kMovedKnob.center) * 0.5;
  return {.first = kBefore, .earlier = true, .place = cube(middle, 0.1), .around = cube(middle, 0.4)};
}

TEST(MovedAreas, HoldWhatContradictsTheOtherPositionAroundThePlace) {
  const SmallMasks masks = moved_masks(kBefore, kAfter, kSize);
  const MovedPart part = part_of_the_knob();
  const std::vector<Area> areas = moved_areas(masks, part);
  ASSERT_EQ(areas.size(), masks.masks.size());
  size_t changed = 0, held = 0, in_place = 0, beside = 0;
  for (size_t v = 0; v < areas.size(); ++v) {
    ASSERT_EQ(areas[v].empty(), part.shown_by_most(v)) << v;
    if (areas[v].empty()) continue;
    const Ball knobs[] = {kKnob, kMovedKnob};
    const Area differs = changed_pixels(masks.cameras[v]), place = seen_hull(part.place, masks.cameras[v]),
               near = dilated(seen_balls(knobs, masks.cameras[v]), kSize, kSize, 3);
    for (size_t i = 0; i < differs.size(); ++i) {
      changed += differs[i];
      held += differs[i] && areas[v][i];
      in_place += differs[i] && place[i];
      beside += areas[v][i] && !near[i] && !place[i];
    }
  }
  EXPECT_LT(double(in_place), 0.5 * double(changed));
  EXPECT_GT(double(held), 0.8 * double(changed));  // the rest is thinner than five pixels
  EXPECT_LT(double(beside), 0.02 * double(held));
}

// What is wrong elsewhere in a mask is another finding.
TEST(MovedAreas, DoNotHoldWhatIsNotJoinedToThePlace) {
  SmallMasks masks = moved_masks(kBefore, kAfter, kSize);
  const MovedPart part = part_of_the_knob();
  const std::vector<Area> before = moved_areas(masks, part);
  const Ball hole{{-0.2, -0.1, 0}, 0.15};
  for (size_t v = kBefore; v < masks.masks.size(); ++v) {
    const Area cut = seen_balls({&hole, 1}, masks.cameras[v]), changed = changed_pixels(masks.cameras[v]);
    for (size_t i = 0; i < cut.size(); ++i)
      if (cut[i] && !changed[i]) masks.masks[v][i] = kBackground;
  }
  const std::vector<Area> after = moved_areas(masks, part);
  size_t more = 0, cut = 0;
  for (size_t v = kBefore; v < after.size(); ++v) {
    cut += pixels_in(seen_balls({&hole, 1}, masks.cameras[v]));
    for (size_t i = 0; i < after[v].size(); ++i) more += after[v][i] && !before[v][i];
  }
  EXPECT_LT(double(more), 0.2 * double(cut));
}

// A ball that a neck in the place joins to the body: doubtful where it is seen beside the body, but not where
// it is seen before it.
TEST(MovedAreas, HoldPiecesThatThePlaceCutsOff) {
  const Ball neck{{0.55, 0, 0}, 0.08}, end{{0.75, 0, 0}, 0.16}, balls[] = {kBody, neck, end};
  const MovedPart part{
      .first = kBefore, .earlier = true, .place = cube(neck.center, 0.09), .around = cube(neck.center, 0.5)};
  SmallMasks masks = moved_masks(kBefore, kAfter, kSize);
  for (size_t v = 0; v < masks.masks.size(); ++v) masks.masks[v] = seen_balls(balls, masks.cameras[v]);
  const std::vector<Area> areas = moved_areas(masks, part);
  int cut_off = 0, before_the_body = 0;
  for (size_t v = kBefore; v < areas.size(); ++v) {
    const Camera& camera = masks.cameras[v];
    const Area shown = seen_balls({&end, 1}, camera), body = seen_balls({&kBody, 1}, camera),
               place = seen_hull(part.place, camera);
    size_t beside = 0, before = 0, held = 0;
    for (size_t i = 0; i < shown.size(); ++i) {
      if (!shown[i] || place[i]) continue;
      ++(body[i] ? before : beside);
      held += areas[v][i];
    }
    if (beside > 100 && before == 0) {
      ++cut_off;
      EXPECT_EQ(held, beside) << v;
    } else if (before > 100) {
      ++before_the_body;
      EXPECT_EQ(held, 0u) << v;
    }
  }
  EXPECT_GT(cut_off, 1);
  EXPECT_GT(before_the_body, 1);
}

// Else a view would have no object left.
TEST(MovedAreas, LeaveAnObjectThatIsAllAroundThePlace) {
  const SmallMasks masks = moved_masks(kBefore, kAfter, kSize);
  MovedPart part = part_of_the_knob();
  part.around = cube({0, 0, 0}, 0.9);
  const std::vector<Area> areas = moved_areas(masks, part);
  for (size_t v = kBefore; v < areas.size(); ++v) {
    size_t object = 0, held = 0;
    for (size_t i = 0; i < areas[v].size(); ++i)
      if (masks.masks[v][i] == kObject) ++object, held += areas[v][i];
    EXPECT_LT(2 * held, object) << v;
  }
}

}  // namespace
}  // namespace cei3d
