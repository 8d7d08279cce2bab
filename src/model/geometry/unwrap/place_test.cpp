// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/place.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

namespace cei3d {
namespace {

BitGrid random_grid(int width, int height, int percent, std::mt19937& random) {
  BitGrid grid(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (int(random() % 100) < percent) grid.set(x, y);
  return grid;
}

bool fits(const BitGrid& taken, const BitGrid& piece, int x, int y) {
  for (int v = 0; v < piece.height(); ++v)
    for (int u = 0; u < piece.width(); ++u)
      if (piece.at(u, v) && taken.at(x + u, y + v)) return false;
  return true;
}

std::optional<Place> by_brute_force(const BitGrid& taken, const BitGrid& piece, int limit) {
  for (int y = 0; y < limit && y + piece.height() <= taken.height(); ++y)
    for (int x = 0; x + piece.width() <= taken.width(); ++x)
      if (fits(taken, piece, x, y)) return Place{x, y};
  return std::nullopt;
}

TEST(Place, TheLowestPlaceIsThatOfBruteForce) {
  std::mt19937 random(5);
  int found = 0;
  for (int round = 0; round < 300; ++round) {
    const BitGrid taken = random_grid(130, 40, 2 + round % 9, random);
    const BitGrid piece = random_grid(1 + int(random() % 70), 1 + int(random() % 9), 20 + round % 70, random);
    const int limit = 10 + round % 40;
    const auto wanted = by_brute_force(taken, piece, limit);
    const auto got = Taken(taken).lowest_place(footprint_of(piece), limit);
    ASSERT_EQ(got.has_value(), wanted.has_value()) << round;
    if (!got) continue;
    ++found;
    EXPECT_EQ(got->x, wanted->x) << round;
    EXPECT_EQ(got->y, wanted->y) << round;
  }
  EXPECT_GT(found, 50);
}

// One piece after the other, as an atlas is packed.
TEST(Place, AGridThatFillsUpGivesThePlacesOfBruteForce) {
  std::mt19937 random(6);
  Taken taken(BitGrid(30, 60));
  int found = 0;
  for (int round = 0; round < 200; ++round) {
    const BitGrid piece =
        random_grid(3 + int(random() % 8), 3 + int(random() % 6), 60 + 40 * (round % 2), random);
    const auto wanted = by_brute_force(taken.cells(), piece, 60);
    const auto got = taken.lowest_place(footprint_of(piece), 60);
    ASSERT_EQ(got.has_value(), wanted.has_value()) << round;
    if (!got) continue;
    ++found;
    EXPECT_EQ(got->x, wanted->x) << round;
    EXPECT_EQ(got->y, wanted->y) << round;
    taken.take(footprint_of(piece), *got, round % 2);
  }
  EXPECT_GT(found, 10);
  EXPECT_LT(found, 200);
}

TEST(Place, ATakenPlaceKeepsItsDistance) {
  Taken taken(BitGrid(40, 40));
  BitGrid piece(3, 3);
  piece.set(1, 1);
  taken.take(footprint_of(piece), {10, 10}, 2);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 40; ++x)
      EXPECT_EQ(taken.cells().at(x, y), std::max(std::abs(x - 11), std::abs(y - 11)) <= 2);
}

}  // namespace
}  // namespace cei3d
