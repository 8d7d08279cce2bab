// SPDX-License-Identifier: Apache-2.0
#include "engine/reconstruct/geometry/pixel_errors.h"

#include <gtest/gtest.h>

#include <vector>

namespace cei3d {
namespace {

constexpr int kPixels = 1000, kDraws = 40000;

std::vector<int> counts(const PixelErrors& errors) {
  std::vector<int> n(kPixels);
  for (int i = 0; i < kDraws; ++i) {
    Rng rng(1, 2, uint64_t(i));
    ++n[errors.choose(rng)];
  }
  return n;
}

TEST(PixelErrors, DrawsPixelsNeverRenderedFirst) {
  PixelErrors errors(kPixels);
  for (int i = 0; i < kPixels / 2; ++i) errors.record({size_t(i), 9});
  int seen = 0;
  const std::vector<int> n = counts(errors);
  for (int i = 0; i < kPixels / 2; ++i) seen += n[i];
  EXPECT_NEAR(seen, kDraws / 8, kDraws / 60);  // only when all three are among these
}

// The largest of three: the lower share q of all pixels comes with probability q^3.
TEST(PixelErrors, DrawsAPixelTheMoreOftenTheLargerItsError) {
  PixelErrors errors(kPixels);
  for (int i = 0; i < kPixels; ++i) errors.record({size_t(i), float(i / 16)});
  const std::vector<int> n = counts(errors);
  int lowest = 0, highest = 0;
  for (int i = 0; i < 250; ++i) lowest += n[i], highest += n[kPixels - 1 - i];
  EXPECT_NEAR(lowest, kDraws / 64, kDraws / 300);
  EXPECT_NEAR(highest, kDraws * 37 / 64, kDraws / 50);
}

TEST(PixelErrors, ForgetsOldErrors) {
  PixelErrors errors(32);
  for (size_t i = 0; i < 32; ++i) errors.record({i, 1});
  for (int k = 0; k < 20; ++k)
    for (size_t i = 0; i < 16; ++i) errors.record({i, 0});
  int first = 0;
  for (int i = 0; i < 1000; ++i) {
    Rng rng(1, 2, uint64_t(i));
    first += errors.choose(rng) < 16;
  }
  EXPECT_NEAR(first, 125, 45);
}

}  // namespace
}  // namespace cei3d
