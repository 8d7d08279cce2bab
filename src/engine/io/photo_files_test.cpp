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
#include "engine/io/png_file.h"
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
  EXPECT_FALSE(notes.auto_white);
  EXPECT_EQ(read_exif(with_exif(jpeg, 1, 0)).auto_white, true);
  EXPECT_EQ(read_exif(with_exif(jpeg, 1, 1)).auto_white, false);
  EXPECT_FALSE(read_exif(with_exif(jpeg, 1, 7)).auto_white);
  EXPECT_NEAR(read_exif(with_exif(jpeg, 1, 1)).exposure.value_or(0), 200.0 / 50 / 16, 1e-12);
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
  EXPECT_EQ(profile_kind(profile), ProfileKind::other);
  EXPECT_EQ(jpeg_profile(with_profile(jpeg, profile)), profile);
  EXPECT_EQ(jpeg_profile(jpeg), "");
  write_file_atomic(temp.path() / "a.jpg", with_profile(jpeg, profile));
  const Image linear = read_linear_image(temp.path() / "a.jpg");
  EXPECT_NEAR(linear.at(5, 5)[0], 0.3f, 0.01f);
  EXPECT_NEAR(linear.at(5, 5)[1], 0.8f, 0.01f);
  EXPECT_NEAR(linear.at(5, 5)[2], 0.1f, 0.01f);
}

// Damaged profiles, and those of printing inks: the image counts as sRGB, and that can be told.
TEST(ColorProfile, ThatCannotBeUsedIsPassedOver) {
  const TempFolder temp;
  const std::string jpeg = encode_jpeg(Image(16, 16, 3, 0.5f), 100), p3 = p3_profile();
  const auto path = temp.path() / "a.jpg";
  const std::string unusable[] = {"no color profile", p3.substr(0, 200),
                                  std::string(p3).replace(16, 4, "CMYK")};
  for (const std::string& profile : unusable) {
    EXPECT_EQ(profile_kind(profile), ProfileKind::unusable);
    write_file_atomic(path, with_profile(jpeg, profile));
    EXPECT_TRUE(has_unusable_profile(path));
    EXPECT_NEAR(read_linear_image(path).at(5, 5)[1], linear_from_srgb(0.5f), 0.005f);
  }
  for (const std::string& usable : {jpeg, with_profile(jpeg, p3)}) {
    write_file_atomic(path, usable);
    EXPECT_FALSE(has_unusable_profile(path));
  }
  std::string png = encode_png(Image(4, 4, 3, 0.5f), 8);
  write_file_atomic(path, png);
  EXPECT_FALSE(has_unusable_profile(path));
  png.insert(33, std::string("\0\0\0\2iCCPxx\0\0\0\0", 14));  // behind the header; its sum is wrong, too
  write_file_atomic(path, png);
  EXPECT_TRUE(has_unusable_profile(path));
  EXPECT_FLOAT_EQ(read_linear_image(path).at(1, 1)[0], linear_from_srgb(128.0f / 255));
}

// gAMA of 1, of 0.55, and of 1 / 2.2, which stands for sRGB; also beside a chunk that says sRGB.
TEST(Png, StoredExponentsAreUndone) {
  const TempFolder temp;
  const std::string png = encode_png(Image(3, 2, 4, 51.0f / 255), 8);
  const auto read = [&](const std::string& chunks) {
    write_file_atomic(temp.path() / "a.png", std::string(png).insert(33, chunks));  // behind the header
    const Image linear = read_linear_image(temp.path() / "a.png");
    EXPECT_FLOAT_EQ(linear.at(1, 1)[3], 0.2f);
    return linear.at(1, 1)[0];
  };
  const std::string one("\0\0\0\4gAMA\0\1\x86\xa0\x31\xe8\x96\x5f", 16),
      other("\0\0\0\4gAMA\0\0\xd6\xd8\xd4\x4f\x58\x32", 16),
      usual("\0\0\0\4gAMA\0\0\xb1\x8f\x0b\xfc\x61\x05", 16), srgb("\0\0\0\1sRGB\0\xae\xce\x1c\xe9", 13);
  EXPECT_FLOAT_EQ(read(one), 0.2f);
  EXPECT_NEAR(read(other), std::pow(0.2, 1 / 0.55), 1e-6);
  for (const std::string& chunks : {std::string(), usual, srgb, srgb + usual})
    EXPECT_FLOAT_EQ(read(chunks), linear_from_srgb(0.2f));
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
