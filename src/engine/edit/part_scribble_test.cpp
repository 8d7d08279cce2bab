// SPDX-License-Identifier: Apache-2.0
#include "engine/edit/part_scribble.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/math/color.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr int kWide = 14, kHigh = 11;

void draw(Image& rgba, int x, int y, Vec3f srgb) {
  for (int c = 0; c < 3; ++c) rgba.at(x, y)[c] = srgb[c];
  rgba.at(x, y)[3] = 1;
}

// Tries every rectangle.
int64_t largest_area(const Image& mask) {
  int64_t best = 0;
  for (int y0 = 0; y0 < mask.height; ++y0)
    for (int x0 = 0; x0 < mask.width; ++x0)
      for (int y1 = y0; y1 < mask.height; ++y1)
        for (int x1 = x0; x1 < mask.width; ++x1) {
          bool filled = true;
          for (int y = y0; y <= y1; ++y)
            for (int x = x0; x <= x1; ++x) filled &= *mask.at(x, y) > 0;
          if (filled) best = std::max(best, int64_t(x1 - x0 + 1) * (y1 - y0 + 1));
        }
  return best;
}

TEST(PartScribble, ThePatternIsTheLargestRectangleThatIsDrawn) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    Image rgba(kWide, kHigh, 4);
    for (int y = 0; y < kHigh; ++y)
      for (int x = 0; x < kWide; ++x) {
        Rng rng(seed, 0, uint64_t(y * kWide + x));
        if (rng.uniform() < 0.8f) draw(rgba, x, y, {rng.uniform(), rng.uniform(), rng.uniform()});
      }
    const PartScribble s = part_scribble(rgba, {}, std::nullopt);
    EXPECT_EQ(int64_t(s.tile.width) * s.tile.height, largest_area(s.positive));
    for (int y = 0; y < s.tile.height; ++y)
      for (int x = 0; x < s.tile.width; ++x) {
        EXPECT_EQ(*s.positive.at(s.x0 + x, s.y0 + y), 1);
        EXPECT_EQ(s.tile.at(x, y)[1], linear_from_srgb(rgba.at(s.x0 + x, s.y0 + y)[1]));
      }
  }
}

TEST(PartScribble, StrokesOfOneColorAreNoPattern) {
  Image rgba(kWide, kHigh, 4);
  for (int x = 0; x < kWide; ++x) draw(rgba, x, 4, {0.5f + 0.02f * float(x % 2), 0.25f, 0});
  const PartScribble s = part_scribble(rgba, {}, std::nullopt);
  EXPECT_TRUE(s.one_color());
  EXPECT_NEAR(s.tile.data[1], linear_from_srgb(0.25f), 1e-6);
}

TEST(PartScribble, StrokesOfTheNegativeColorAreBesideThePart) {
  Image rgba(kWide, kHigh, 4), beside(kWide, kHigh, 4);
  for (int x = 0; x < kWide; ++x) {
    draw(rgba, x, 2, {1, 0, 0});
    draw(rgba, x, 5, {0, 0.5f, 1});
    draw(beside, x, 8, {1, 0, 0});
  }
  const PartScribble s = part_scribble(rgba, beside, linear_from_srgb(Vec3f{0, 0.5f, 1}));
  EXPECT_TRUE(s.one_color());
  EXPECT_EQ(s.tile.data[0], 1);
  for (int y = 0; y < kHigh; ++y) {
    EXPECT_EQ(*s.positive.at(3, y), y == 2);
    EXPECT_EQ(*s.negative.at(3, y), y == 5 || y == 8);
  }
}

}  // namespace
}  // namespace cei3d
