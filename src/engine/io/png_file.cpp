// SPDX-License-Identifier: Apache-2.0
// libpng reports errors by longjmp. Therefore every sequence of calls runs in a small function over plain
// data (no destructors between setjmp and longjmp), and objects that own memory live in the callers.
#include "engine/io/png_file.h"

#include <png.h>

#include <cmath>
#include <csetjmp>
#include <cstdint>
#include <cstring>
#include <vector>

#include "core/base/error.h"
#include "engine/io/image_limits.h"

namespace cei3d {
namespace {

struct Source {
  const char* data;
  size_t size, used;
  char error[200];
};

void on_error(png_structp png, png_const_charp text) {
  auto* message = static_cast<char*>(png_get_error_ptr(png));
  std::strncpy(message, text, 199);
  png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}

void read_bytes(png_structp png, png_bytep out, size_t n) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (n > source->size - source->used) png_error(png, "it ends too early");
  std::memcpy(out, source->data + source->used, n);
  source->used += n;
}

// Calls step(png, info, context); false after a libpng error.
template <class Context>
bool guarded(png_structp png, png_infop info, void (*step)(png_structp, png_infop, Context*),
             Context* context) {
  if (setjmp(png_jmpbuf(png))) return false;
  step(png, info, context);
  return true;
}

struct Header {
  uint32_t width, height;
  int channels, bits;
};

// Owned by libpng.
struct Profile {
  png_bytep data;
  png_uint_32 size;
};

void read_header(png_structp png, png_infop info, Header* h) {
  png_set_user_limits(png, kMaxImageSide, kMaxImageSide);
  png_read_info(png, info);
  if (png_get_color_type(png, info) == PNG_COLOR_TYPE_GRAY_ALPHA ||
      (png_get_color_type(png, info) == PNG_COLOR_TYPE_GRAY && png_get_valid(png, info, PNG_INFO_tRNS)))
    png_set_gray_to_rgb(png);
  png_set_expand(png);
  if (png_get_bit_depth(png, info) == 16) png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  h->width = png_get_image_width(png, info);
  h->height = png_get_image_height(png, info);
  h->channels = png_get_channels(png, info);
  h->bits = png_get_bit_depth(png, info);
}

void read_profile(png_structp png, png_infop info, Profile* out) {
  png_set_user_limits(png, kMaxImageSide, kMaxImageSide);
  png_read_info(png, info);
  png_charp name = nullptr;
  int compression = 0;
  png_get_iCCP(png, info, &name, &compression, &out->data, &out->size);
}

void read_gamma(png_structp png, png_infop info, double* out) {
  png_set_user_limits(png, kMaxImageSide, kMaxImageSide);
  png_read_info(png, info);
  if (!png_get_valid(png, info, PNG_INFO_sRGB)) png_get_gAMA(png, info, out);
}

void read_rows(png_structp png, png_infop, png_bytepp rows) {
  png_read_image(png, rows);
  png_read_end(png, nullptr);
}

class Reader {
 public:
  Reader(const std::string& bytes, const std::string& name)
      : name_(name), source_{bytes.data(), bytes.size(), 0, {}} {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, source_.error, on_error, on_warning);
    info_ = png_ ? png_create_info_struct(png_) : nullptr;
    if (!info_) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      fail("{}: out of memory while reading a PNG.", name);
    }
    png_set_read_fn(png_, &source_, read_bytes);
  }
  ~Reader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  Header header() {
    Header h{};
    require(guarded(png_, info_, read_header, &h));
    return h;
  }
  std::string profile() {
    Profile p{};
    if (!guarded(png_, info_, read_profile, &p) || !p.data) return "";
    return {reinterpret_cast<const char*>(p.data), p.size};
  }
  double gamma() {  // 0: not stated
    double value = 0;
    return guarded(png_, info_, read_gamma, &value) ? value : 0;
  }
  void rows(png_bytepp rows) { require(guarded(png_, info_, read_rows, rows)); }
  void require(bool ok) {
    if (!ok) fail("{} is a broken PNG: {}. Copy or render it again.", name_, source_.error);
  }

 private:
  const std::string& name_;
  Source source_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

struct Sink {
  std::string bytes;
  char error[200] = {};
};

void write_bytes(png_structp png, png_bytep data, size_t n) {
  bool ok = true;
  try {
    static_cast<Sink*>(png_get_io_ptr(png))->bytes.append(reinterpret_cast<char*>(data), n);
  } catch (const std::bad_alloc&) {
    ok = false;
  }
  if (!ok) png_error(png, "out of memory");
}
void flush_bytes(png_structp) {}

struct Output {
  Header header;
  png_bytepp rows;
};

void write_all(png_structp png, png_infop info, Output* out) {
  const Header& h = out->header;
  const int type = h.channels == 1   ? PNG_COLOR_TYPE_GRAY
                   : h.channels == 3 ? PNG_COLOR_TYPE_RGB
                                     : PNG_COLOR_TYPE_RGB_ALPHA;
  png_set_IHDR(png, info, h.width, h.height, h.bits, type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_compression_level(png, 4);  // a third of the time of the default level, files a few per cent larger
  png_write_info(png, info);
  if (h.bits == 16) png_set_swap(png);
  png_write_image(png, out->rows);
  png_write_end(png, nullptr);
}

std::vector<png_bytep> row_pointers(std::vector<uint8_t>& data, size_t height) {
  std::vector<png_bytep> rows(height);
  for (size_t y = 0; y < height; ++y) rows[y] = data.data() + y * (data.size() / height);
  return rows;
}

uint32_t quantize(float v, float top) {
  return v > 0 ? uint32_t(std::min(v, 1.0f) * top + 0.5f) : 0;
}  // NaN: 0

}  // namespace

Image decode_png(const std::string& bytes, const std::string& name) {
  Reader reader(bytes, name);
  const Header h = reader.header();
  readable_size(h.width, h.height, bytes.size(), name);
  std::vector<uint8_t> data(size_t(h.width) * h.height * h.channels * (h.bits / 8));
  reader.rows(row_pointers(data, h.height).data());

  Image image(int(h.width), int(h.height), h.channels);
  if (h.bits == 8)
    for (size_t i = 0; i < image.data.size(); ++i) image.data[i] = float(data[i]) / 255.0f;
  else
    for (size_t i = 0; i < image.data.size(); ++i) {
      uint16_t v;
      std::memcpy(&v, &data[2 * i], 2);
      image.data[i] = float(v) / 65535.0f;
    }
  return image;
}

std::string png_profile(const std::string& bytes, const std::string& name) {
  return Reader(bytes, name).profile();
}

bool png_has_profile(const std::string& bytes) {
  for (size_t at = 8; at + 8 <= bytes.size();) {
    const std::string kind = bytes.substr(at + 4, 4);
    if (kind == "iCCP" || kind == "IDAT") return kind == "iCCP";  // it stands before the pixels
    at += 12 + size_t(png_get_uint_32(reinterpret_cast<png_const_bytep>(bytes.data() + at)));
  }
  return false;
}

std::optional<double> png_gamma(const std::string& bytes, const std::string& name) {
  constexpr double kSrgb = 1 / 2.2, kAbout = 0.05;
  const double gamma = Reader(bytes, name).gamma();
  if (!(gamma > 0) || std::abs(gamma / kSrgb - 1) < kAbout) return std::nullopt;
  return gamma;
}

std::string encode_png(const Image& image, int bits) {
  if (image.empty() || (image.channels != 1 && image.channels != 3 && image.channels != 4))
    fail("Cannot write a PNG of {} x {} pixels with {} channels.", image.width, image.height, image.channels);
  std::vector<uint8_t> data(image.data.size() * (bits / 8));
  for (size_t i = 0; i < image.data.size(); ++i) {
    if (bits == 8) {
      data[i] = uint8_t(quantize(image.data[i], 255));
    } else {
      const uint16_t v = uint16_t(quantize(image.data[i], 65535));
      std::memcpy(&data[2 * i], &v, 2);
    }
  }
  Sink sink;
  std::vector<png_bytep> rows = row_pointers(data, image.height);
  Output out{{uint32_t(image.width), uint32_t(image.height), image.channels, bits}, rows.data()};
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, sink.error, on_error, on_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  if (info) png_set_write_fn(png, &sink, write_bytes, flush_bytes);
  const bool ok = info && guarded(png, info, write_all, &out);
  png_destroy_write_struct(&png, &info);
  if (!ok) fail("Cannot make a PNG: {}.", sink.error[0] ? sink.error : "out of memory");
  return std::move(sink.bytes);
}

}  // namespace cei3d
