// SPDX-License-Identifier: Apache-2.0
#include "core/image/resample.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace cei3d {
namespace {

TEST(Downscale, MeanOfBlocksAndCutBorder) {
  Image image(5, 2, 1);
  image.data = {1, 2, 3, 4, 99, 5, 6, 7, 8, 99};
  const Image small = downscale(image, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 1);
  EXPECT_EQ(small.data, (std::vector<float>{3.5f, 5.5f}));
}

TEST(Downscale, TransparentPixelsDoNotDarkenColor) {
  Image image(2, 2, 4);
  image.at(0, 0)[0] = 0.8f;
  image.at(0, 0)[3] = 1;
  image.at(1, 1)[0] = 0.4f;
  image.at(1, 1)[3] = 1;
  const Image small = downscale(image, 2);
  EXPECT_FLOAT_EQ(small.at(0, 0)[0], 0.6f);
  EXPECT_FLOAT_EQ(small.at(0, 0)[3], 0.5f);
}

TEST(Downscale, BlocksWithUnknownPixelsAreUnknown) {
  Image image(4, 2, 4, 1.0f);
  image.at(3, 1)[3] = -1;
  const Image small = downscale(image, 2);
  EXPECT_EQ(small.at(0, 0)[3], 1);
  EXPECT_EQ(small.at(1, 0)[3], -1);
}

TEST(ScaledTo, KeepsARamp) {
  Image ramp(8, 4, 1);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) *ramp.at(x, y) = float(x) + 0.5f;
  const Image large = scaled_to(ramp, 16, 8);
  for (int x = 1; x < 15; ++x) EXPECT_FLOAT_EQ(*large.at(x, 3), (float(x) + 0.5f) / 2);
}

TEST(Cropped, HasThePixelsOfTheBox) {
  Image image(3, 2, 2);
  for (size_t i = 0; i < image.data.size(); ++i) image.data[i] = float(i);  // 01 23 45 / 67 89 1011
  const Image part = cropped(image, {1, 1, 2, 1});
  EXPECT_EQ(part.width, 2);
  EXPECT_EQ(part.height, 1);
  EXPECT_EQ(part.data, (std::vector<float>{8, 9, 10, 11}));
}

// Each orientation by where it moves the corners.
TEST(Turned, MovesCornersAsExifSays) {
  Image image(3, 2, 1);
  for (size_t i = 0; i < 6; ++i) image.data[i] = float(i);  // 0 1 2 / 3 4 5
  EXPECT_EQ(turned(image, 5).data, (std::vector<float>{0, 3, 1, 4, 2, 5}));
  EXPECT_EQ(turned(image, 6).data, (std::vector<float>{3, 0, 4, 1, 5, 2}));
  EXPECT_EQ(turned(image, 7).data, (std::vector<float>{5, 2, 4, 1, 3, 0}));
  EXPECT_EQ(turned(image, 8).data, (std::vector<float>{2, 5, 1, 4, 0, 3}));
  EXPECT_EQ(turned(image, 6).width, 2);
  EXPECT_EQ(turned(image, 3).data, image.data);
}

TEST(Downscale, ImpossibleFactorIsAnError) {
  EXPECT_THROW(downscale(Image(4, 4, 3), 0), Error);
  EXPECT_THROW(downscale(Image(4, 4, 3), 5), Error);
}

}  // namespace
}  // namespace cei3d
