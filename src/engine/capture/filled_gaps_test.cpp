// SPDX-License-Identifier: Apache-2.0
#include "engine/capture/filled_gaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/capture/test_moved.h"

namespace cei3d {
namespace {

constexpr int kSize = 128, kViews = 40;

// Balls on a circle about the axis y, which the camera of some view looks along, that touch each other: a
// ring with a hole.
std::vector<Ball> ring(int balls, double radius, double ball_radius) {
  std::vector<Ball> out;
  for (int i = 0; i < balls; ++i) {
    const double angle = 2 * std::numbers::pi * i / balls;
    out.push_back({{radius * std::cos(angle), 0, radius * std::sin(angle)}, ball_radius});
  }
  return out;
}

SmallMasks masks_of(std::span<const Ball> balls) {
  SmallMasks out;
  for (const Camera& c : spread_cameras(kViews, lens_of_size(kSize, kSize))) {
    out.cameras.push_back(c);
    out.masks.push_back(seen_balls(balls, c));  // kBackground is 0, kObject 1
  }
  return out;
}

// The view that looks most along the ring's axis.
size_t view_through(const SmallMasks& masks) {
  size_t best = 0;
  const auto along = [&](size_t v) { return std::abs(normalize(masks.cameras[v].center).y); };
  for (size_t v = 0; v < masks.cameras.size(); ++v)
    if (along(v) > along(best)) best = v;
  return best;
}

// Fills the hole of the ring in one mask; returns it.
Area fill_hole(SmallMasks& masks, size_t view, double radius) {
  const Ball plug{{0, 0, 0}, radius};
  Area hole = seen_balls({&plug, 1}, masks.cameras[view]);
  for (size_t i = 0; i < hole.size(); ++i) {
    hole[i] = hole[i] && masks.masks[view][i] == kBackground;
    if (hole[i]) masks.masks[view][i] = kObject;
  }
  return hole;
}

std::vector<Area> gaps_in(const SmallMasks& masks) {
  return filled_gaps(masks, Area(masks.masks.size(), uint8_t(1)));
}

TEST(FilledGaps, AHoleThatOneMaskFillsIsFound) {
  SmallMasks masks = masks_of(ring(24, 0.5, 0.2));
  const size_t view = view_through(masks);
  const Area hole = fill_hole(masks, view, 0.4);
  ASSERT_GT(pixels_in(hole), 200u);
  const std::vector<Area> gaps = gaps_in(masks);
  ASSERT_EQ(gaps.size(), masks.masks.size());
  for (size_t v = 0; v < gaps.size(); ++v) EXPECT_EQ(gaps[v].empty(), v != view) << v;
  ASSERT_FALSE(gaps[view].empty());
  EXPECT_GT(share_of(gaps[view], hole), 0.95);
  EXPECT_GT(share_of(dilated(hole, kSize, kSize, 2), gaps[view]), 0.99);
}

// Also of an object of few pixels' thickness, whose cells nearly all views contradict.
TEST(FilledGaps, TrueMasksFillNone) {
  for (const double thickness : {0.2, 0.03})
    for (const Area& gap : gaps_in(masks_of(ring(thickness > 0.1 ? 24 : 120, 0.6, thickness))))
      EXPECT_TRUE(gap.empty()) << thickness;
}

// A part that most views do not show at all.
TEST(FilledGaps, WhatFewViewsSeeIsNotAGap) {
  const Ball body{{0, 0, 0}, 0.5}, knob{{0.45, 0.1, 0.3}, 0.2}, around{knob.center, 0.25};
  const Ball both[] = {body, knob};
  SmallMasks masks = masks_of(both);
  for (size_t v = 0; v < masks.masks.size(); ++v) {
    if (v % 6 == 0) continue;
    const Area unknown = seen_balls({&around, 1}, masks.cameras[v]);
    for (size_t i = 0; i < unknown.size(); ++i)
      if (unknown[i]) masks.masks[v][i] = kUnknown;
  }
  for (const Area& gap : gaps_in(masks)) EXPECT_TRUE(gap.empty());
}

// Views that show a part in another place look past where most have it.
TEST(FilledGaps, ViewsOfAnotherStateHaveNoVote) {
  constexpr size_t kBefore = 30, kAfter = 6;
  const SmallMasks masks = moved_masks(kBefore, kAfter, kSize);
  Area has_vote(kBefore + kAfter, uint8_t(1));
  const auto found = [&] {
    const std::vector<Area> gaps = filled_gaps(masks, has_vote);
    return std::count_if(gaps.begin(), gaps.begin() + kBefore, [](const Area& a) { return !a.empty(); });
  };
  EXPECT_GT(found(), 0);
  std::fill(has_vote.begin() + kBefore, has_vote.end(), uint8_t(0));
  EXPECT_EQ(found(), 0);
}

// One mask that has a hole where there is none does not speak against all others.
TEST(FilledGaps, OneMaskWithAHoleDoesNotAccuseOthers) {
  const Ball body[] = {{{0, 0, 0}, 0.7}}, hole[] = {{{0.2, 0.1, 0}, 0.2}};
  SmallMasks masks = masks_of(body);
  const Area cut = seen_balls(hole, masks.cameras[7]);
  for (size_t i = 0; i < cut.size(); ++i)
    if (cut[i]) masks.masks[7][i] = kBackground;
  for (const Area& gap : gaps_in(masks)) EXPECT_TRUE(gap.empty());
}

}  // namespace
}  // namespace cei3d
