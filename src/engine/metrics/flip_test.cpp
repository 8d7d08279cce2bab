// SPDX-License-Identifier: Apache-2.0
#include "engine/metrics/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/error.h"
#include "core/math/color.h"

namespace cei3d {
namespace {

Image constant(int size, Vec3f srgb) {
  Image image(size, size, 3);
  for (size_t i = 0; i < image.data.size(); ++i) image.data[i] = srgb[i % 3];
  return image;
}

Image noise(int size, unsigned seed) {
  Image image(size, size, 3);
  std::mt19937 random(seed);
  for (float& v : image.data) v = float(random() % 256) / 255;
  return image;
}

TEST(Flip, NothingForEqualImagesAndTheSameInBothDirections) {
  const Image a = noise(24, 1), b = noise(24, 2);
  EXPECT_EQ(flip(a, a), 0);
  EXPECT_NEAR(flip(a, b), flip(b, a), 1e-9);
  for (const float e : flip_map(a, b).data) EXPECT_TRUE(e >= 0 && e <= 1);
}

// Images of one color have no features: the error is that of the colors, by hand from the paper's formulas.
// Black against white: HyAB 100, exponent 0.7: 25.119. Green against blue: L*a*b* (87.735, -86.183, 83.180)
// and (32.297, 79.188, -107.860); chroma times L*/100: HyAB 203.3, to the power 0.7: 41.27, the largest.
TEST(Flip, OneColorAgainstAnother) {
  EXPECT_NEAR(flip(constant(8, {0, 1, 0}), constant(8, {0, 0, 1})), 1, 1e-4);
  const double bend = 0.4 * 41.27;
  EXPECT_NEAR(flip(constant(8, {0, 0, 0}), constant(8, {1, 1, 1})),
              0.95 + (25.119 - bend) / (41.27 - bend) * 0.05, 1e-4);
  // Two grays: only lightness differs. L* 53.389 of sRGB 0.5, 43.192 of 0.4.
  EXPECT_NEAR(flip(constant(8, {0.5f, 0.5f, 0.5f}), constant(8, {0.4f, 0.4f, 0.4f})),
              0.95 / bend * std::pow(53.389 - 43.192, 0.7), 2e-4);
}

// A checkerboard of pixels and its mean: from far away they look alike.
TEST(Flip, FineDetailIsNotSeenFromFarAway) {
  constexpr int kSize = 64;
  Image board(kSize, kSize, 3);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      for (int c = 0; c < 3; ++c) board.at(x, y)[c] = (x + y) % 2 ? 1.0f : 0.0f;
  const float gray = srgb_from_linear(0.5f);
  const Image mean = constant(kSize, {gray, gray, gray});
  const auto middle = [&](double pixels_per_degree) {
    return *flip_map(board, mean, pixels_per_degree).at(kSize / 2, kSize / 2);
  };
  EXPECT_LT(middle(200), 0.02);
  EXPECT_GT(middle(10), 0.3);
}

// Near an edge that the reference lacks, the same difference of color is seen more.
TEST(Flip, EdgesCount) {
  constexpr int kSize = 64;
  const auto step = [](int at, float low, float high) {
    Image image(kSize, kSize, 3);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        for (int c = 0; c < 3; ++c) image.at(x, y)[c] = x < at ? low : high;
    return image;
  };
  const Image flat = constant(kSize, {0.5f, 0.5f, 0.5f});
  const Image map = flip_map(step(32, 0.45f, 0.55f), flat);
  EXPECT_GT(*map.at(28, 32), 1.05f * *map.at(8, 32));
  // The same color difference without an edge.
  EXPECT_NEAR(*map.at(4, 32), *flip_map(constant(kSize, {0.45f, 0.45f, 0.45f}), flat).at(4, 32), 1e-3);
}

TEST(Flip, OfAnAreaIsTheMeanOfItsPixels) {
  const Image a = noise(16, 3), b = noise(16, 4), map = flip_map(a, b);
  Area area(map.data.size(), 0);
  area[5] = area[77] = 1;
  EXPECT_NEAR(*flip_in_area(a, b, area), (double(map.data[5]) + double(map.data[77])) / 2, 1e-12);
  EXPECT_FALSE(flip_in_area(a, b, Area(map.data.size(), 0)));
  EXPECT_THROW(flip(a, noise(15, 1)), Error);
}

}  // namespace
}  // namespace cei3d
