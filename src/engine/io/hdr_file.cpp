// SPDX-License-Identifier: Apache-2.0
#include "engine/io/hdr_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "core/base/error.h"
#include "engine/io/image_limits.h"

namespace cei3d {
namespace {

using Rgbe = std::array<uint8_t, 4>;

class Reader {
 public:
  Reader(const std::string& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  [[noreturn]] void broken(const char* why) const {
    fail("{} is a broken or unusual HDR image: {}.", name_, why);
  }

  std::string line() {
    const size_t end = bytes_.find('\n', position_);
    if (end == std::string::npos || end - position_ > 4096) broken("its header does not end");
    const std::string text = bytes_.substr(position_, end - position_);
    position_ = end + 1;
    return text;
  }
  uint8_t byte() {
    if (position_ >= bytes_.size()) broken("it ends too early");
    return uint8_t(bytes_[position_++]);
  }
  Rgbe pixel() {
    const uint8_t r = byte(), g = byte(), b = byte(), e = byte();
    return {r, g, b, e};
  }
  size_t left() const { return bytes_.size() - position_; }
  ImageSize readable(ImageSize s) const { return readable_size(s.width, s.height, bytes_.size(), name_); }

 private:
  const std::string& bytes_;
  const std::string& name_;
  size_t position_ = 0;
};

struct Header {
  ImageSize size;
  double exposure = 1;
};

Header read_header(Reader& in) {
  Header header;
  if (in.line().rfind("#?", 0) != 0) in.broken("it does not start with #?RADIANCE");
  for (std::string text = in.line(); !text.empty(); text = in.line()) {
    if (text.rfind("FORMAT=", 0) == 0 && text.rfind("FORMAT=32-bit_rle_rgbe", 0) != 0)
      in.broken("its colors are not RGBE");
    if (text.rfind("EXPOSURE=", 0) == 0) header.exposure *= std::atof(text.c_str() + 9);
  }
  if (!(header.exposure > 0) || !std::isfinite(header.exposure)) in.broken("its exposure is impossible");
  ImageSize& size = header.size;
  if (std::sscanf(in.line().c_str(), "-Y %d +X %d", &size.height, &size.width) != 2)
    in.broken("its rows don't run from the top");
  size = in.readable(size);
  return header;
}

// New style: the four components one after the other, each run-length encoded.
void read_components(Reader& in, std::vector<Rgbe>& row) {
  for (int c = 0; c < 4; ++c)
    for (size_t x = 0; x < row.size();) {
      const uint8_t code = in.byte();
      const size_t n = code > 128 ? code - 128u : code;
      if (n == 0 || n > row.size() - x) in.broken("a run is longer than its row");
      const uint8_t value = code > 128 ? in.byte() : 0;
      for (size_t i = 0; i < n; ++i) row[x++][c] = code > 128 ? value : in.byte();
    }
}

// Flat pixels, in which (1, 1, 1, n) repeats the last pixel n times; several in a row are digits of base 256.
void read_pixels(Reader& in, std::vector<Rgbe>& row, Rgbe first) {
  int shift = 0;
  Rgbe pixel = first;
  for (size_t x = 0;;) {
    if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
      const size_t n = shift < 24 ? size_t(pixel[3]) << shift : row.size() + 1;
      if (x == 0 || n > row.size() - x) in.broken("a run is longer than its row");
      std::fill_n(row.begin() + std::ptrdiff_t(x), n, row[x - 1]);
      x += n;
      shift += 8;
    } else {
      row[x++] = pixel;
      shift = 0;
    }
    if (x == row.size()) return;
    pixel = in.pixel();
  }
}

void read_row(Reader& in, std::vector<Rgbe>& row) {
  const Rgbe head = in.pixel();
  const bool coded = head[0] == 2 && head[1] == 2 && head[2] < 128 && row.size() >= 8 && row.size() < 32768;
  if (!coded) return read_pixels(in, row, head);
  if (size_t(head[2]) * 256 + head[3] != row.size()) in.broken("a row has another width than the image");
  read_components(in, row);
}

Rgbe encode(const float* p) {
  const auto clean = [](float v) { return v > 0 ? std::min(v, 1e38f) : 0.0f; };  // NaN: 0
  const float r = clean(p[0]), g = clean(p[1]), b = clean(p[2]), top = std::max({r, g, b});
  if (top < 1e-32f) return {0, 0, 0, 0};
  int exponent = 0;
  std::frexp(top, &exponent);
  const auto digit = [&](float v) {
    return uint8_t(std::min(255L, std::lround(std::ldexp(v, 8 - exponent))));
  };
  return {digit(r), digit(g), digit(b), uint8_t(std::min(exponent + 128, 255))};
}

}  // namespace

ImageSize hdr_size(const std::string& bytes, const std::string& name) {
  Reader in(bytes, name);
  return read_header(in).size;
}

Image decode_hdr(const std::string& bytes, const std::string& name) {
  Reader in(bytes, name);
  const Header header = read_header(in);
  // A row takes at least 4 bytes.
  if (in.left() < size_t(header.size.height) * 4) in.broken("it ends too early");
  Image image(header.size.width, header.size.height, 3);
  std::vector<Rgbe> row(size_t(header.size.width));
  for (int y = 0; y < image.height; ++y) {
    read_row(in, row);
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] =
            row[x][3] == 0 ? 0.0f
                           : float(std::ldexp(double(row[x][c]), int(row[x][3]) - 136) / header.exposure);
  }
  return image;
}

std::string encode_hdr(const Image& image) {
  if (image.empty() || image.channels < 3)
    fail("Cannot write an HDR image with {} channels.", image.channels);
  std::string out =
      fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {} +X {}\n", image.height, image.width);
  // Other rows could be mistaken for encoded ones.
  const bool coded = image.width >= 8 && image.width < 32768;
  for (int y = 0; y < image.height; ++y) {
    std::vector<Rgbe> row(size_t(image.width));
    for (int x = 0; x < image.width; ++x) row[x] = encode(image.at(x, y));
    if (coded) out += {2, 2, char(image.width >> 8), char(image.width & 255)};
    for (int c = 0; coded && c < 4; ++c)
      for (int x = 0; x < image.width;) {
        const int n = std::min(128, image.width - x);
        out += char(n);
        for (int i = 0; i < n; ++i) out += char(row[x++][c]);
      }
    for (int x = 0; !coded && x < image.width; ++x)
      out.append(reinterpret_cast<const char*>(row[x].data()), 4);
  }
  return out;
}

}  // namespace cei3d
