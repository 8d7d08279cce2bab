// SPDX-License-Identifier: Apache-2.0
// Small files whose headers state sizes that would take gigabytes.
#include "engine/io/image_limits.h"

#include <gmock/gmock.h>

#include <functional>

#include "core/base/bytes.h"
#include "core/base/error_of.h"
#include "core/base/file.h"
#include "core/base/temp_folder.h"
#include "engine/io/exr_file.h"
#include "engine/io/hdr_file.h"
#include "engine/io/image_file.h"
#include "engine/io/jpeg_file.h"
#include "engine/io/png_file.h"
#include "engine/io/tiff_file.h"
#include "engine/io/webp_file.h"

namespace cei3d {
namespace {
using testing::AllOf;
using testing::HasSubstr;

std::string big_endian(uint64_t v, int count) {
  std::string out;
  for (int i = count - 1; i >= 0; --i) out += char(v >> (8 * i) & 255);
  return out;
}

template <class T>
std::string little_endian(T v) {
  std::string out;
  append_bytes(out, v);
  return out;
}

size_t place(const std::string& bytes, const std::string& what) {
  const size_t at = bytes.find(what);
  EXPECT_NE(at, std::string::npos);
  return at;
}

std::string png_of(uint32_t w, uint32_t h) {
  std::string bytes = encode_png(Image(8, 8, 3, 0.5f), 8);
  bytes.replace(16, 8, big_endian(w, 4) + big_endian(h, 4));
  uint32_t crc = ~0u;  // of the chunk IHDR, by the definition in the format
  for (size_t i = 12; i < 29; ++i) {
    crc ^= uint8_t(bytes[i]);
    for (int k = 0; k < 8; ++k) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
  }
  return bytes.replace(29, 4, big_endian(~crc, 4));
}

std::string jpeg_of(uint32_t w, uint32_t h) {
  std::string bytes = encode_jpeg(Image(8, 8, 3, 0.5f), 90);
  return bytes.replace(place(bytes, "\xff\xc0") + 5, 4, big_endian(h, 2) + big_endian(w, 2));
}

std::string tiff_of(uint32_t w, uint32_t h) {
  std::string bytes = encode_tiff(Image(8, 8, 3, 0.5f));
  const size_t directory = 8 + 2 * 8 * 8 * 3, value = directory + 2 + 8;
  return bytes.replace(value, 4, little_endian(w)).replace(value + 12, 4, little_endian(h));
}

std::string exr_of(uint32_t w, uint32_t h) {
  std::string bytes = encode_exr(Image(8, 8, 3, 0.5f));
  for (const char* window : {"dataWindow", "displayWindow"})
    bytes.replace(place(bytes, window) + std::string(window).size() + sizeof "\0box2i" + 4 + 8, 8,
                  little_endian(w - 1) + little_endian(h - 1));
  return bytes;
}

std::string hdr_of(uint32_t w, uint32_t h) {
  const std::string row = "\x80\x80\x80\x80\1\1\1\7";  // a pixel, and seven more of its color
  std::string out = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", h, w);
  for (uint32_t y = 0; y < h; ++y) out += row;
  return out;
}

std::string webp_of(uint32_t w, uint32_t h) {
  std::string bytes = encode_webp(Image(8, 8, 3, 0.5f), kLossless);
  return bytes.replace(21, 4, little_endian((w - 1) | (h - 1) << 14));
}

struct Format {
  const char* name;
  std::string (*file_of)(uint32_t w, uint32_t h);
  Image (*decode)(const std::string&, const std::string&);
};
Image tiff_image(const std::string& bytes, const std::string& name) { return decode_tiff(bytes, name).image; }
const Format kFormats[] = {{"a.png", png_of, decode_png},
                           {"a.jpg", jpeg_of, decode_jpeg},
                           {"a.tif", tiff_of, tiff_image},
                           {"a.exr", exr_of, decode_exr},
                           {"a.hdr", hdr_of, decode_hdr}};
constexpr size_t kLong = size_t(1) << 30;  // bytes

TEST(ImageLimits, HeadersOfTheTestAreThoseOfTheFormats) {
  for (const Format& f : kFormats) EXPECT_EQ(f.decode(f.file_of(8, 8), f.name).width, 8) << f.name;
  EXPECT_EQ(decode_webp(webp_of(8, 8), "a.webp").width, 8);
}

TEST(ImageLimits, HugeSizesAreRefusedByNameAndSize) {
  const TempFolder temp;
  for (const Format& f : kFormats) {
    const std::string bytes = f.file_of(65500, 65500);
    const auto says = AllOf(HasSubstr(f.name), HasSubstr("65500 x 65500 pixels"), HasSubstr("268 million"));
    EXPECT_THAT(message([&] { f.decode(bytes, f.name); }), says);
    write_file_atomic(temp.path() / f.name, bytes);
    EXPECT_THAT(message([&] { read_image(temp.path() / f.name); }), says);
    EXPECT_THAT(message([&] { read_image_size(temp.path() / f.name); }), says);
  }
}

// Found by fuzzing: the library would take 1.9 GB for a value of a type that it does not know.
TEST(ImageLimits, ValuesInAnExrHeaderThatAreLongerThanTheFileAreRefused) {
  std::string bytes = encode_exr(Image(8, 8, 3, 0.5f));
  const size_t size = place(bytes, "pixelAspectRatio") + sizeof "pixelAspectRatio" + sizeof "float";
  bytes.replace(size - sizeof "float", 5, "f1oat").replace(size, 4, little_endian(uint32_t{0x73690000}));
  EXPECT_THAT(message([&] { decode_exr(bytes, "a.exr"); }),
              AllOf(HasSubstr("a.exr"), HasSubstr("longer than the file")));
}

// Found by fuzzing: the library reads a list of channels to its end, whatever its stated size, and after that
// it takes 1.9 GB for what it finds there.
TEST(ImageLimits, ValuesInAnExrHeaderAreAsLongAsItSays) {
  std::string bytes = encode_exr(Image(8, 8, 3, 0.5f));
  const size_t size = place(bytes, "channels") + sizeof "channels" + sizeof "chlist";
  bytes.replace(size, 4, little_endian(uint32_t{3 * 18 + 1 + 8}));
  EXPECT_THAT(message([&] { decode_exr(bytes, "a.exr"); }),
              AllOf(HasSubstr("a.exr"), HasSubstr("a value of a wrong size")));
}

// Found by fuzzing, as above, in a file that says that it has several parts.
TEST(ImageLimits, HeadersOfAllPartsOfAnExrAreRead) {
  std::string bytes = encode_exr(Image(8, 8, 3, 0.5f));
  bytes[5] |= 0x10;  // several parts
  const size_t end = place(bytes, "screenWindowWidth") + sizeof "screenWindowWidth" + sizeof "float" + 4 + 4;
  ASSERT_EQ(bytes[end], 0);
  using namespace std::string_literals;
  bytes.insert(end + 1, "a\0f1oat\0"s + little_endian(uint32_t{0x73690000}));
  EXPECT_THAT(message([&] { decode_exr(bytes, "a.exr"); }),
              AllOf(HasSubstr("a.exr"), HasSubstr("longer than the file")));
}

TEST(ImageLimits, FilesTooShortForTheirSizeAreRefused) {
  for (const Format& f : kFormats) {
    if (f.decode == decode_hdr) continue;  // its rows are as long as this bound asks for
    EXPECT_THAT(message([&] { f.decode(f.file_of(16000, 16000), f.name); }),
                AllOf(HasSubstr(f.name), HasSubstr("too few for 16000 x 16000 pixels")));
  }
  EXPECT_THAT(message([] { decode_webp(webp_of(16000, 16000), "a.webp"); }),
              AllOf(HasSubstr("a.webp"), HasSubstr("too few for 16000 x 16000 pixels")));
}

TEST(ImageLimits, BoundsAreWhereTheyAreStated) {
  EXPECT_EQ(readable_size(16384, 16384, kLong, "a"), (ImageSize{16384, 16384}));
  EXPECT_THROW(readable_size(16384, 16385, kLong, "a"), Error);
  EXPECT_EQ(readable_size(65535, 1, kLong, "a"), (ImageSize{65535, 1}));
  EXPECT_THROW(readable_size(65536, 1, kLong, "a"), Error);
  EXPECT_THROW(readable_size(0, 1, kLong, "a"), Error);
  EXPECT_THROW(readable_size(1, -1, kLong, "a"), Error);
  EXPECT_EQ(readable_size(8256, 10, 10, "a").width, 8256);
  EXPECT_THROW(readable_size(8256, 11, 10, "a"), Error);
}

// Nothing is said in fewer bytes than one color everywhere.
TEST(ImageLimits, PicturesOfOneColorAreRead) {
  const Image image(3000, 2000, 3, 0.5f);
  EXPECT_EQ(decode_png(encode_png(image, 8), "a.png").width, 3000);
  EXPECT_EQ(decode_jpeg(encode_jpeg(image, 1), "a.jpg").width, 3000);
  EXPECT_EQ(decode_exr(encode_exr(image), "a.exr").width, 3000);
  EXPECT_EQ(decode_hdr(encode_hdr(image), "a.hdr").width, 3000);
}

}  // namespace
}  // namespace cei3d
