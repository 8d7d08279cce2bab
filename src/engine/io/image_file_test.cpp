// SPDX-License-Identifier: Apache-2.0
#include "engine/io/image_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

#include "core/base/error.h"
#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "core/math/color.h"
#include "engine/io/exr_file.h"
#include "engine/io/hdr_file.h"
#include "engine/io/jpeg_file.h"
#include "engine/io/png_file.h"
#include "engine/io/test_jpeg.h"

namespace cei3d {
namespace {
using testing::HasSubstr;

// Values that n bits can hold, so that round trips are exact.
Image sample(int channels, float top, int w = 13, int h = 7) {
  Image image(w, h, channels);
  std::mt19937 random(1);
  for (float& v : image.data) v = float(random() % (unsigned(top) + 1)) / top;
  return image;
}

void expect_same(const Image& a, const Image& b) {
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  ASSERT_EQ(a.channels, b.channels);
  EXPECT_EQ(a.data, b.data);
}

// Truncations and random damage: an Error that names the file, or a picture; never anything else.
void abuse(const std::string& bytes,
           const std::function<Image(const std::string&, const std::string&)>& decode, bool every_cut_fails) {
  for (size_t n = 0; n < bytes.size(); n += 1 + bytes.size() / 300) {
    try {
      decode(bytes.substr(0, n), "cut.img");
      EXPECT_FALSE(every_cut_fails) << "accepted " << n << " of " << bytes.size();
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr("cut.img"));
    }
  }
  std::mt19937 random(7);
  for (int i = 0; i < 1500; ++i) {
    std::string s = bytes;
    for (int k = 0; k < 4; ++k)
      s[random() % (i % 2 ? s.size() : std::min<size_t>(s.size(), 100))] = char(random());
    try {
      decode(s, "flipped.img");
    } catch (const Error&) {
    }
  }
}

TEST(Png, RoundTripIsExact) {
  for (const int channels : {1, 3, 4}) {
    expect_same(decode_png(encode_png(sample(channels, 255), 8), "x"), sample(channels, 255));
    expect_same(decode_png(encode_png(sample(channels, 65535), 16), "x"), sample(channels, 65535));
  }
}

TEST(Png, ClampsRoundsAndTakesNanForBlack) {
  Image image(4, 1, 1);
  image.data = {-1, 2, NAN, 100.6f / 255};
  EXPECT_EQ(decode_png(encode_png(image, 8), "x").data, (std::vector<float>{0, 1, 0, 101.0f / 255.0f}));
}

// A 2 x 1 picture of 1 bit a pixel: palette red (transparent), blue (opaque); pixels 0, 1. Chunks made by
// hand.
TEST(Png, ExpandsPalettes) {
  const unsigned char bytes[] = {
      0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44, 0x52, 0x00,
      0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x01, 0x03, 0x00, 0x00, 0x00, 0xce, 0xec, 0xed, 0xc9, 0x00,
      0x00, 0x00, 0x06, 0x50, 0x4c, 0x54, 0x45, 0xff, 0x00, 0x00, 0x00, 0x00, 0xff, 0x6c, 0xa1, 0xfd, 0x8e,
      0x00, 0x00, 0x00, 0x01, 0x74, 0x52, 0x4e, 0x53, 0x00, 0x40, 0xe6, 0xd8, 0x66, 0x00, 0x00, 0x00, 0x0a,
      0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x70, 0x00, 0x00, 0x00, 0x42, 0x00, 0x41, 0x29, 0x37, 0xf4,
      0xef, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
  const Image image = decode_png(std::string(reinterpret_cast<const char*>(bytes), sizeof bytes), "x");
  EXPECT_EQ(image.channels, 4);
  EXPECT_EQ(image.data, (std::vector<float>{1, 0, 0, 0, 0, 0, 1, 1}));
}

TEST(Png, DamageIsAnErrorOrAPicture) {
  abuse(encode_png(sample(4, 255, 40, 30), 8), decode_png, true);
  abuse(encode_png(sample(3, 65535, 40, 30), 16), decode_png, true);
}

TEST(Jpeg, DecodesWhatItEncodes) {
  Image image(32, 24, 3);
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 32; ++x)
      image.at(x, y)[0] = float(x) / 31, image.at(x, y)[1] = float(y) / 23, image.at(x, y)[2] = 0.5f;
  const std::string bytes = encode_jpeg(image, 95);
  const Image back = decode_jpeg(bytes, "x");
  ASSERT_EQ(back.data.size(), image.data.size());
  for (size_t i = 0; i < image.data.size(); ++i) EXPECT_NEAR(back.data[i], image.data[i], 0.03);
  abuse(bytes, decode_jpeg, true);
}

TEST(Jpeg, OfPrintingInksSaysSo) {
  for (const auto& [transform, sampling] : {std::pair<char, char>{0, 0x11}, {2, 0x11}, {2, 0x22}}) {
    const std::string bytes = ink_jpeg(transform, sampling);
    const auto says = testing::AllOf(HasSubstr("ink.jpg"), HasSubstr("CMYK"), HasSubstr("as RGB"));
    EXPECT_THAT(message([&] { decode_jpeg(bytes, "ink.jpg"); }), says);
    EXPECT_THAT(message([&] { jpeg_size(bytes, "ink.jpg"); }), says);
  }
}

TEST(Exr, RoundTripIsExact) {
  for (const int channels : {1, 3, 4}) {
    Image image = sample(channels, 1000, 19, 33);
    for (float& v : image.data) v = v * 1234.5f - 3;
    expect_same(decode_exr(encode_exr(image), "x"), image);
    EXPECT_EQ(exr_size(encode_exr(image), "x"), (ImageSize{19, 33}));
  }
  abuse(encode_exr(sample(4, 255, 40, 30)), decode_exr, false);
  const std::string bytes = encode_exr(sample(3, 255, 40, 30));
  EXPECT_THROW(decode_exr(bytes.substr(0, bytes.size() * 3 / 4), "cut"), Error);
}

TEST(Hdr, RoundTripWithinTheFormat) {
  for (const int width : {3, 8, 200}) {
    Image image = sample(3, 1000, width, 5);
    for (size_t i = 0; i < image.data.size(); ++i) image.data[i] *= std::pow(10.0f, float(i % 7) - 3);
    image.at(0, 0)[0] = image.at(0, 0)[1] = image.at(0, 0)[2] = 0;
    const Image back = decode_hdr(encode_hdr(image), "x");
    ASSERT_EQ(back.data.size(), image.data.size());
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < width; ++x) {
        const float* p = image.at(x, y);
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(back.at(x, y)[c], p[c], std::max({p[0], p[1], p[2]}) / 256 + 1e-30);
      }
  }
  abuse(encode_hdr(sample(3, 255, 40, 30)), decode_hdr, true);
  abuse(encode_hdr(sample(3, 255, 5, 30)), decode_hdr, true);
}

// Coded by hand from the format's description: one old-style run, one new-style row with runs, an exposure.
TEST(Hdr, ReadsRunsAndExposure) {
  std::string old_style = "#?RGBE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 4\n";
  old_style += std::string("\x80\x40\x20\x81\x01\x01\x01\x03", 8);
  const Image a = decode_hdr(old_style, "x");
  for (int x = 0; x < 4; ++x) EXPECT_EQ(a.at(x, 0)[0], 0.5f) << x;  // 128 / 256 * 2^1 / 2
  std::string new_style = "#?RADIANCE\n\n-Y 1 +X 8\n";
  new_style += std::string("\x02\x02\x00\x08", 4) + "\x88\x40" + "\x88\x80" +
               std::string("\x08\x01\x02\x03\x04\x05\x06\x07\x08", 9) + "\x88\x80";
  const Image b = decode_hdr(new_style, "x");
  EXPECT_EQ(b.at(7, 0)[0], 0.25f);
  EXPECT_EQ(b.at(7, 0)[1], 0.5f);
  EXPECT_EQ(b.at(7, 0)[2], 8.0f / 256);
}

TEST(ImageFile, KindIsToldByContentAndSizeWithoutDecoding) {
  const TempFolder temp;
  const Image image = sample(3, 255, 21, 9);
  write_png(temp.path() / "a.jpg", image);  // a wrong suffix does not matter
  write_exr(temp.path() / "b.exr", image);
  write_hdr(temp.path() / "c.hdr", image);
  write_file_atomic(temp.path() / "d.jpg", encode_jpeg(image, 90));
  for (const char* name : {"a.jpg", "b.exr", "c.hdr", "d.jpg"}) {
    EXPECT_EQ(read_image_size(temp.path() / name), (ImageSize{21, 9})) << name;
    EXPECT_EQ(read_image(temp.path() / name).width, 21) << name;
  }
  expect_same(read_image(temp.path() / "a.jpg"), image);
  EXPECT_EQ(read_linear_image(temp.path() / "a.jpg").data[5], linear_from_srgb(image.data[5]));
  EXPECT_EQ(read_linear_image(temp.path() / "b.exr").data[5], image.data[5]);
}

TEST(ImageFile, ErrorsNameTheFile) {
  const TempFolder temp;
  write_file_atomic(temp.path() / "empty.png", "");
  write_file_atomic(temp.path() / "text.png", "hello, this is text");
  for (const char* name : {"none.png", "empty.png", "text.png"}) {
    try {
      read_image(temp.path() / name);
      FAIL();
    } catch (const Error& e) {
      EXPECT_THAT(e.what(), HasSubstr(name));
    }
    EXPECT_THROW(read_image_size(temp.path() / name), Error);
  }
  EXPECT_THROW(encode_png(Image(3, 3, 2), 8), Error);
  EXPECT_THROW(encode_png(Image(), 8), Error);
}

TEST(ImageFile, SrgbKeepsAlpha) {
  Image image(1, 1, 4, 0.5f);
  const Image srgb = srgb_from_linear(image);
  EXPECT_FLOAT_EQ(srgb.data[0], srgb_from_linear(0.5f));
  EXPECT_EQ(srgb.data[3], 0.5f);
  EXPECT_NEAR(linear_from_srgb(srgb).data[0], 0.5f, 1e-6);
}

}  // namespace
}  // namespace cei3d
