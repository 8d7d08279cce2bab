// SPDX-License-Identifier: Apache-2.0
#include "engine/io/webp_file.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"

namespace cei3d {
namespace {

Image waves() {
  Image image(60, 40, 3);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x)
      for (int c = 0; c < 3; ++c)
        image.data[size_t(3 * (y * 60 + x) + c)] =
            float(128 + int(100 * std::sin(0.1 * x + 0.07 * y + 0.4 * c))) / 255;
  return image;
}

double mean_square(const Image& a, const Image& b) {
  double sum = 0;
  for (size_t i = 0; i < a.data.size(); ++i) sum += std::pow(a.data[i] - b.data[i], 2.0);
  return sum / double(a.data.size());
}

TEST(WebpFile, LosslessIsExact) {
  const Image image = waves();
  const Image back = decode_webp(encode_webp(image, kLossless), "x");
  EXPECT_EQ(back.width, 60);
  EXPECT_EQ(mean_square(image, back), 0);
}

TEST(WebpFile, LossyIsCloseAndSmaller) {
  const Image image = waves();
  const std::string bytes = encode_webp(image, 90);
  EXPECT_LT(mean_square(image, decode_webp(bytes, "x")), 4e-4);
  EXPECT_LT(bytes.size(), image.data.size());
}

TEST(WebpFile, DamageAndOtherChannelsAreRefused) {
  const std::string bytes = encode_webp(waves(), 90);
  EXPECT_THROW(decode_webp(bytes.substr(0, 20), "x"), Error);
  EXPECT_THROW(decode_webp("", "x"), Error);
  EXPECT_THROW(encode_webp(Image(4, 4, 1), 90), Error);
  EXPECT_THROW(encode_webp(Image(17000, 1, 3), 90), Error);
}

}  // namespace
}  // namespace cei3d
