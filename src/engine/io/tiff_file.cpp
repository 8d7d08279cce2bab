// SPDX-License-Identifier: Apache-2.0
#include "engine/io/tiff_file.h"

#include <tiffio.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "engine/io/image_limits.h"

namespace cei3d {
namespace {

// A file in memory, as libtiff's callbacks see it.
struct Memory {
  const std::string* bytes;
  uint64_t at = 0;
};

tmsize_t read_bytes(thandle_t handle, void* out, tmsize_t n) {
  auto* m = static_cast<Memory*>(handle);
  const uint64_t size = m->bytes->size(),
                 count = m->at < size ? std::min<uint64_t>(uint64_t(n), size - m->at) : 0;
  std::memcpy(out, m->bytes->data() + std::min(m->at, size), count);
  m->at += count;
  return tmsize_t(count);
}
tmsize_t write_nothing(thandle_t, void*, tmsize_t) { return 0; }
toff_t seek(thandle_t handle, toff_t offset, int whence) {
  auto* m = static_cast<Memory*>(handle);
  m->at = whence == SEEK_SET ? offset : whence == SEEK_CUR ? m->at + offset : m->bytes->size() + offset;
  return m->at;
}
int close_nothing(thandle_t) { return 0; }
toff_t size_of(thandle_t handle) { return static_cast<Memory*>(handle)->bytes->size(); }

struct Close {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};

class Reader {
 public:
  Reader(const std::string& bytes, const std::string& name) : name_(name), memory_{&bytes} {
    TIFFSetErrorHandler(nullptr);
    TIFFSetWarningHandler(nullptr);
    tiff_.reset(TIFFClientOpen("", "rm", &memory_, read_bytes, write_nothing, seek, close_nothing, size_of,
                               nullptr, nullptr));
    if (!tiff_) broken();
  }
  [[noreturn]] void broken() const { fail("{} is a broken TIFF. Copy or export it again.", name_); }
  TIFF* get() const { return tiff_.get(); }
  template <class T>
  T field(uint32_t tag) const {
    T value{};
    TIFFGetFieldDefaulted(tiff_.get(), tag, &value);
    return value;
  }
  ImageSize size() const {
    const auto w = field<uint32_t>(TIFFTAG_IMAGEWIDTH), h = field<uint32_t>(TIFFTAG_IMAGELENGTH);
    return readable_size(w, h, memory_.bytes->size(), name_);
  }

 private:
  const std::string& name_;
  Memory memory_;
  std::unique_ptr<TIFF, Close> tiff_;
};

struct Layout {
  ImageSize size;
  int channels = 0, bits = 0;
  bool floating = false, associated = false;
};

Layout layout_of(const Reader& r, const std::string& name) {
  Layout l{r.size()};
  l.channels = r.field<uint16_t>(TIFFTAG_SAMPLESPERPIXEL), l.bits = r.field<uint16_t>(TIFFTAG_BITSPERSAMPLE);
  l.floating = r.field<uint16_t>(TIFFTAG_SAMPLEFORMAT) == SAMPLEFORMAT_IEEEFP;
  const auto photometric = r.field<uint16_t>(TIFFTAG_PHOTOMETRIC);
  const bool plain = photometric == PHOTOMETRIC_RGB || photometric == PHOTOMETRIC_MINISBLACK;
  const bool depth = l.floating ? l.bits == 32 : l.bits == 8 || l.bits == 16;
  const bool count = l.channels == 1 || l.channels == 3 || l.channels == 4;
  if (!plain || !depth || !count || TIFFIsTiled(r.get()) ||
      r.field<uint16_t>(TIFFTAG_PLANARCONFIG) != PLANARCONFIG_CONTIG)
    fail("{} is a TIFF of {} channels of {} bits in a layout that is not supported. Convert it to PNG.", name,
         l.channels, l.bits);
  uint16_t extra = 0;
  const uint16_t* kinds = nullptr;
  TIFFGetFieldDefaulted(r.get(), TIFFTAG_EXTRASAMPLES, &extra, &kinds);
  l.associated = extra == 1 && kinds && kinds[0] == EXTRASAMPLE_ASSOCALPHA;
  return l;
}

float sample(const uint8_t* row, size_t i, const Layout& l) {
  if (l.floating) {
    float v;
    std::memcpy(&v, row + 4 * i, 4);
    return v;
  }
  if (l.bits == 8) return float(row[i]) / 255.0f;
  uint16_t v;
  std::memcpy(&v, row + 2 * i, 2);
  return float(v) / 65535.0f;
}

std::string profile_of(const Reader& reader) {
  uint32_t length = 0;
  void* profile = nullptr;
  if (!TIFFGetField(reader.get(), TIFFTAG_ICCPROFILE, &length, &profile)) return "";
  return {static_cast<const char*>(profile), length};
}

}  // namespace

ImageSize tiff_size(const std::string& bytes, const std::string& name) { return Reader(bytes, name).size(); }

int tiff_bits(const std::string& bytes, const std::string& name) {
  return layout_of(Reader(bytes, name), name).bits;
}

std::string tiff_profile(const std::string& bytes, const std::string& name) {
  return profile_of(Reader(bytes, name));
}

TiffImage decode_tiff(const std::string& bytes, const std::string& name) {
  const Reader reader(bytes, name);
  const Layout l = layout_of(reader, name);
  const size_t size = size_t(l.size.width) * l.size.height * size_t(l.channels) * size_t(l.bits / 8);
  const auto line = size_t(TIFFScanlineSize64(reader.get()));
  if (line != size / size_t(l.size.height)) reader.broken();
  TiffImage out{Image(l.size.width, l.size.height, l.channels), l.floating, {}};
  std::vector<uint8_t> row(line);
  for (int y = 0; y < l.size.height; ++y) {
    if (TIFFReadScanline(reader.get(), row.data(), uint32_t(y)) < 0) reader.broken();
    float* to = out.image.at(0, y);
    for (size_t i = 0; i < size_t(l.size.width) * size_t(l.channels); ++i) to[i] = sample(row.data(), i, l);
  }
  if (l.associated)
    for (size_t i = 0; i < out.image.data.size(); i += 4)
      for (size_t c = 0; c < 3 && out.image.data[i + 3] > 0; ++c)
        out.image.data[i + c] /= out.image.data[i + 3];
  out.profile = profile_of(reader);
  return out;
}

std::string encode_tiff(const Image& image) {
  const auto rgb = uint16_t(image.channels >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK);
  const size_t count = image.data.size();
  std::string out = "II";
  append_bytes(out, uint16_t(42));
  append_bytes(out, uint32_t(8 + 2 * count));
  for (const float v : image.data) append_bytes(out, uint16_t(std::clamp(v, 0.0f, 1.0f) * 65535 + 0.5f));
  const size_t entries = image.channels == 4 ? 10 : 9, after = out.size() + 2 + 12 * entries + 4;
  append_bytes(out, uint16_t(entries));
  const auto entry = [&](uint16_t tag, uint16_t type, uint32_t n, uint32_t value) {
    append_bytes(out, tag), append_bytes(out, type), append_bytes(out, n), append_bytes(out, value);
  };
  const bool several = image.channels > 2;
  entry(256, 4, 1, uint32_t(image.width));
  entry(257, 4, 1, uint32_t(image.height));
  entry(258, 3, uint32_t(image.channels), several ? uint32_t(after) : 16);
  entry(259, 3, 1, 1);
  entry(262, 3, 1, rgb);
  entry(273, 4, 1, 8);
  entry(277, 3, 1, uint32_t(image.channels));
  entry(278, 4, 1, uint32_t(image.height));
  entry(279, 4, 1, uint32_t(2 * count));
  if (image.channels == 4) entry(338, 3, 1, 2);
  append_bytes(out, uint32_t(0));
  for (int c = 0; several && c < image.channels; ++c) append_bytes(out, uint16_t(16));
  return out;
}

}  // namespace cei3d
