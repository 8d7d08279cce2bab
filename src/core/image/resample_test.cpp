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

TEST(Downscale, ImpossibleFactorIsAnError) {
  EXPECT_THROW(downscale(Image(4, 4, 3), 0), Error);
  EXPECT_THROW(downscale(Image(4, 4, 3), 5), Error);
}

}  // namespace
}  // namespace cei3d
