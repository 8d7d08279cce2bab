// SPDX-License-Identifier: Apache-2.0
#include "core/image/area.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/math/rng.h"

namespace cei3d {
namespace {

constexpr int kWidth = 19, kHeight = 13;

Area random_area(uint64_t seed) {
  Area area(size_t(kWidth) * kHeight);
  Rng rng(seed, 0, 0);
  for (uint8_t& v : area) v = rng.uniform() < 0.85f;
  return area;
}

// Whether all pixels of the image in the square about (x, y) are in the area.
bool square_fits(const Area& area, int x, int y, int radius) {
  for (int j = 0; j < kHeight; ++j)
    for (int i = 0; i < kWidth; ++i)
      if (std::abs(i - x) <= radius && std::abs(j - y) <= radius && !area[size_t(j) * kWidth + i])
        return false;
  return true;
}

TEST(Area, ErodedKeepsTheCentersOfSquaresThatFit) {
  for (const int radius : {0, 1, 2}) {
    const Area area = random_area(uint64_t(radius)), out = eroded(area, kWidth, kHeight, radius);
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        EXPECT_EQ(bool(out[size_t(y) * kWidth + x]), square_fits(area, x, y, radius)) << x << " " << y;
  }
}

TEST(Area, OpenedKeepsTheSquaresThatFit) {
  constexpr int kRadius = 1;
  const Area area = random_area(7), out = opened(area, kWidth, kHeight, kRadius);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      bool covered = false;
      for (int j = 0; j < kHeight; ++j)
        for (int i = 0; i < kWidth; ++i)
          covered |=
              std::abs(i - x) <= kRadius && std::abs(j - y) <= kRadius && square_fits(area, i, j, kRadius);
      EXPECT_EQ(bool(out[size_t(y) * kWidth + x]), covered) << x << " " << y;
    }
}

// A part has a seed, or it has none: nothing of the area beside the result touches it.
TEST(Area, PartsWithSeedsAreWholeAndNoOthersAreKept) {
  const Area area = random_area(7);
  Area seeds(area.size());
  seeds[size_t(3) * kWidth + 5] = seeds[size_t(9) * kWidth + 12] = 1;
  const Area out = parts_with(seeds, area, kWidth, kHeight);
  EXPECT_GT(pixels_in(out), 0u);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const size_t i = size_t(y) * kWidth + x;
      EXPECT_LE(out[i], area[i]);
      EXPECT_GE(out[i], seeds[i] * area[i]);
      const bool right = x + 1 < kWidth && area[i] && area[i + 1],
                 below = y + 1 < kHeight && area[i] && area[i + kWidth];
      EXPECT_TRUE(!right || out[i] == out[i + 1]);
      EXPECT_TRUE(!below || out[i] == out[i + kWidth]);
    }
  EXPECT_EQ(pixels_in(parts_with(Area(area.size()), area, kWidth, kHeight)), 0u);
}

}  // namespace
}  // namespace cei3d
