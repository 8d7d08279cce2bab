// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/base/error.h"
#include "engine/metrics/psnr.h"
#include "engine/metrics/ssim.h"

namespace cei3d {
namespace {

Image noise(int w, int h, unsigned seed) {
  Image image(w, h, 3);
  std::mt19937 random(seed);
  for (float& v : image.data) v = float(random() % 256) / 255;
  return image;
}

TEST(Psnr, HandValues) {
  Image a(2, 1, 3, 0.5f), b = a;
  EXPECT_TRUE(std::isinf(psnr(a, b)));
  b.data[0] = 0.6f;  // mse = 0.01 / 6
  EXPECT_NEAR(psnr(a, b), -10 * std::log10(0.01 / 6), 1e-4);
  const std::vector<uint8_t> first{1, 0}, second{0, 1}, none{0, 0};
  EXPECT_NEAR(*psnr_in_mask(a, b, first), -10 * std::log10(0.01 / 3), 1e-4);
  EXPECT_TRUE(std::isinf(*psnr_in_mask(a, b, second)));
  EXPECT_FALSE(psnr_in_mask(a, b, none));
  EXPECT_NEAR(psnr(Image(3, 3, 3, 0.0f), Image(3, 3, 3, 1.0f)), 0, 1e-12);
}

TEST(Psnr, BackgroundShowsThroughInDisplaySpace) {
  Image rgba(1, 1, 4);
  rgba.data = {0.2f, 0.4f, 0.6f, 0.25f};
  const Image out = over_background(rgba, 1);
  EXPECT_FLOAT_EQ(out.data[0], 0.2f * 0.25f + 0.75f);
  EXPECT_FLOAT_EQ(out.data[2], 0.6f * 0.25f + 0.75f);
  EXPECT_EQ(over_background(Image(1, 1, 1, 0.3f), 1).data, (std::vector<float>{0.3f, 0.3f, 0.3f}));
}

TEST(Ssim, OneForEqualPicturesAndSymmetric) {
  const Image a = noise(20, 14, 1), b = noise(20, 14, 2);
  EXPECT_NEAR(ssim(a, a), 1, 1e-12);
  EXPECT_NEAR(ssim(a, b), ssim(b, a), 1e-12);
  EXPECT_LT(ssim(a, b), 0.3);
}

// Constant pictures have no variance: only the luminance term is left.
TEST(Ssim, ConstantPictures) {
  const double x = 0.25, y = 0.75;
  EXPECT_NEAR(ssim(Image(11, 11, 3, float(x)), Image(13 - 2, 11, 3, float(y))),
              (2 * x * y + 1e-4) / (x * x + y * y + 1e-4), 1e-6);
}

// A picture and its negative about 1/2: means mirror, covariance is minus the variance. One window: 11 x 11.
TEST(Ssim, NegativeOfACheckerboard) {
  Image a(11, 11, 3), b(11, 11, 3);
  double w[11], sum = 0, mean = 0;
  for (int i = 0; i < 11; ++i) sum += w[i] = std::exp(-0.5 * (i - 5) * (i - 5) / 2.25);
  for (int y = 0; y < 11; ++y)
    for (int x = 0; x < 11; ++x) {
      const float v = (x + y) % 2 ? 1.0f : 0.0f;
      mean += v * w[x] * w[y] / (sum * sum);
      for (int c = 0; c < 3; ++c) a.at(x, y)[c] = v, b.at(x, y)[c] = 1 - v;
    }
  const double other = 1 - mean, variance = mean - mean * mean;  // values are 0 and 1: v^2 = v
  const double truth = (2 * mean * other + 1e-4) * (-2 * variance + 9e-4) /
                       ((mean * mean + other * other + 1e-4) * (2 * variance + 9e-4));
  EXPECT_NEAR(ssim(a, b), truth, 1e-9);
}

// A picture of 12 x 11 has two windows; an area that holds the middle of one of them picks that one.
TEST(Ssim, InAnArea) {
  const Image a = noise(12, 11, 3), b = noise(12, 11, 4);
  const auto left = [](const Image& in) {
    Image out(11, 11, 3);
    for (int y = 0; y < 11; ++y) std::copy(in.at(0, y), in.at(0, y) + 33, out.at(0, y));
    return out;
  };
  Area area(12 * 11, 0);
  EXPECT_FALSE(ssim_in_area(a, b, area));
  area[5 * 12 + 5] = 1;
  EXPECT_NEAR(*ssim_in_area(a, b, area), ssim(left(a), left(b)), 1e-12);
  area.assign(12 * 11, 1);
  EXPECT_NEAR(*ssim_in_area(a, b, area), ssim(a, b), 1e-12);
}

TEST(Area, GrowsByASquareAndStopsAtTheBorder) {
  Area area(5 * 4, 0);
  area[1 * 5 + 0] = 1;
  const Area grown = dilated(area, 5, 4, 1);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x) EXPECT_EQ(grown[size_t(y) * 5 + x], x <= 1 && y <= 2) << x << " " << y;
  EXPECT_EQ(pixels_in(grown), 6u);
  const Image shown = shown_in(Image(5, 4, 3, 0.25f), grown, 1);
  EXPECT_EQ(shown.at(1, 2)[2], 0.25f);
  EXPECT_EQ(shown.at(2, 2)[0], 1.0f);
}

TEST(Metrics, UnequalSizesAreErrors) {
  EXPECT_THROW(psnr(Image(3, 3, 3), Image(3, 4, 3)), Error);
  EXPECT_THROW(psnr(Image(3, 3, 4), Image(3, 3, 4)), Error);
  EXPECT_THROW(psnr(Image(), Image()), Error);
  EXPECT_THROW(psnr_in_mask(Image(3, 3, 3), Image(3, 3, 3), std::vector<uint8_t>(8)), Error);
  EXPECT_THROW(ssim(Image(10, 30, 3), Image(10, 30, 3)), Error);
  EXPECT_THROW(ssim(Image(11, 30, 3), Image(30, 11, 3)), Error);
}

}  // namespace
}  // namespace cei3d
