// SPDX-License-Identifier: Apache-2.0
// What photographs carry besides pixels, and TIFF.
#include <gmock/gmock.h>

#include <random>

#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "core/math/color.h"
#include "engine/io/color_profile.h"
#include "engine/io/image_file.h"
#include "engine/io/test_jpeg.h"
#include "engine/io/tiff_file.h"

namespace cei3d {
namespace {
using testing::HasSubstr;

Image steps(int channels) {
  Image image(6, 5, channels);
  std::mt19937 random(3);
  for (float& v : image.data) v = float(random() % 65536) / 65535;
  return image;
}

TEST(Exif, IsReadFromAJpeg) {
  const TempFolder temp;
  const std::string jpeg = encode_jpeg(Image(8, 6, 3, 0.5f), 90);
  write_file_atomic(temp.path() / "a.jpg", with_exif(jpeg, 6));
  const ExifNotes notes = read_image_exif(temp.path() / "a.jpg");
  EXPECT_EQ(notes.orientation, 6);
  ASSERT_TRUE(notes.exposure);
  EXPECT_NEAR(*notes.exposure, 200.0 / 50 / 16, 1e-12);
  EXPECT_EQ(read_exif(with_exif(jpeg, 9)).orientation, 1);
  EXPECT_EQ(read_exif(jpeg).orientation, 1);
  EXPECT_FALSE(read_exif(jpeg).exposure);
  const std::string bytes = with_exif(jpeg, 3);
  for (size_t n = 0; n < bytes.size(); ++n) read_exif(bytes.substr(0, n));
  std::mt19937 random(1);
  for (int i = 0; i < 2000; ++i) {
    std::string damaged = bytes;
    damaged[random() % 150] = char(random());
    read_exif(damaged);
  }
}

TEST(ColorProfile, ColorsOfOtherPrimariesBecomeSrgbs) {
  const TempFolder temp;
  Image image(16, 16, 3);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) image.at(x, y)[0] = 0.8f, image.at(x, y)[1] = 0.3f, image.at(x, y)[2] = 0.1f;
  const std::string jpeg = encode_jpeg(image, 100), profile = swapped_profile();
  EXPECT_FALSE(is_srgb_profile(profile));
  EXPECT_TRUE(is_srgb_profile("nonsense"));
  EXPECT_EQ(jpeg_profile(with_profile(jpeg, profile)), profile);
  EXPECT_EQ(jpeg_profile(jpeg), "");
  write_file_atomic(temp.path() / "a.jpg", with_profile(jpeg, profile));
  const Image linear = read_linear_image(temp.path() / "a.jpg");
  EXPECT_NEAR(linear.at(5, 5)[0], 0.3f, 0.01f);
  EXPECT_NEAR(linear.at(5, 5)[1], 0.8f, 0.01f);
  EXPECT_NEAR(linear.at(5, 5)[2], 0.1f, 0.01f);
}

TEST(Tiff, SixteenBitsAreReadExactly) {
  const TempFolder temp;
  for (const int channels : {1, 3, 4}) {
    const Image image = steps(channels);
    write_file_atomic(temp.path() / "a.tif", encode_tiff(image));
    EXPECT_EQ(read_image(temp.path() / "a.tif").data, image.data);
    EXPECT_EQ(read_image_size(temp.path() / "a.tif"), (ImageSize{6, 5}));
    EXPECT_FLOAT_EQ(read_linear_image(temp.path() / "a.tif").data[0], linear_from_srgb(image.data[0]));
  }
}

TEST(Tiff, DamageIsAnErrorOrAPicture) {
  const std::string bytes = encode_tiff(steps(4));
  for (size_t n = 0; n < bytes.size(); ++n)
    EXPECT_THAT(message([&] { decode_tiff(bytes.substr(0, n), "cut.tif"); }), HasSubstr("cut.tif"));
  std::mt19937 random(7);
  for (int i = 0; i < 3000; ++i) {
    std::string damaged = bytes;
    damaged[i % 2 ? random() % damaged.size() : damaged.size() - 1 - random() % 140] = char(random());
    try {
      decode_tiff(damaged, "flipped.tif");
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr("flipped.tif"));
    }
  }
}

}  // namespace
}  // namespace cei3d
