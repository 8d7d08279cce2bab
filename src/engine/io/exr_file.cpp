// SPDX-License-Identifier: Apache-2.0
#include "engine/io/exr_file.h"

#include <ImfArray.h>
#include <ImfAttribute.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfVersion.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <vector>

#include "core/base/error.h"
#include "engine/io/image_limits.h"

namespace cei3d {
namespace {

constexpr int kMaxChannels = 128;  // maximum number of channels in a file; most are not read

class Source : public Imf::IStream {
 public:
  Source(const std::string& bytes, const std::string& name) : Imf::IStream(name.c_str()), bytes_(bytes) {}
  bool read(char out[], int n) override {
    if (n < 0 || size_t(n) > bytes_.size() - position_) throw std::runtime_error("it ends too early");
    std::memcpy(out, bytes_.data() + position_, size_t(n));
    position_ += size_t(n);
    return position_ < bytes_.size();
  }
  uint64_t tellg() override { return position_; }
  void seekg(uint64_t position) override {
    if (position > bytes_.size()) throw std::runtime_error("it ends too early");
    position_ = size_t(position);
  }

 private:
  const std::string& bytes_;
  size_t position_ = 0;
};

class Sink : public Imf::OStream {
 public:
  Sink() : Imf::OStream("memory") {}
  void write(const char data[], int n) override {
    if (bytes.size() < position_ + size_t(n)) bytes.resize(position_ + size_t(n));
    std::memcpy(bytes.data() + position_, data, size_t(n));
    position_ += size_t(n);
  }
  uint64_t tellp() override { return position_; }
  void seekp(uint64_t position) override { position_ = size_t(position); }
  std::string bytes;

 private:
  size_t position_ = 0;
};

int64_t width_of(const Imath::Box2i& b) { return int64_t(b.max.x) - b.min.x + 1; }
int64_t height_of(const Imath::Box2i& b) { return int64_t(b.max.y) - b.min.y + 1; }

int channel_count(const Imf::ChannelList& list) {
  int n = 0;
  for (auto i = list.begin(); i != list.end(); ++i) ++n;
  return n;
}

constexpr size_t kStart = 8;  // bytes of the magic number and the version

// A value in a header, as its type reads it, which need not be as long as the header says.
void require_whole(const std::string& type, const std::string& value, int version) {
  Source source(value, type);
  const std::unique_ptr<Imf::Attribute> attribute(Imf::Attribute::newAttribute(type.c_str()));
  attribute->readValueFrom(source, int(value.size()), version);
  if (source.tellg() != value.size()) throw std::runtime_error("its header has a value of a wrong size");
}

// The library takes memory for an attribute of an unknown type by its stated size, which it finds wherever
// the value before ends. An attribute is a name, a type, which end with a zero, the size in 4 bytes,
// little-endian, and the value; an empty name ends the header. Returns where it ends.
size_t require_attributes_fit(const std::string& bytes, size_t at, int version) {
  Imf::staticInitialize();  // the types
  while (at < bytes.size() && bytes[at] != 0) {
    const size_t type = bytes.find('\0', at) + 1, size = type == 0 ? 0 : bytes.find('\0', type) + 1;
    if (size == 0 || bytes.size() - size < 4) throw std::runtime_error("it ends too early");
    uint32_t n = 0;
    std::memcpy(&n, bytes.data() + size, 4);
    if (n > bytes.size() - size - 4) throw std::runtime_error("its header has a value longer than the file");
    const std::string type_name = bytes.substr(type, size - 1 - type);
    if (Imf::Attribute::knownType(type_name.c_str()))
      require_whole(type_name, bytes.substr(size + 4, n), version);
    at = size + 4 + n;
  }
  return at + 1;
}

void require_readable(const Imf::Header& header, size_t bytes, const std::string& name) {
  for (const Imath::Box2i& box : {header.dataWindow(), header.displayWindow()})
    readable_size(width_of(box), height_of(box), bytes, name);
  if (channel_count(header.channels()) > kMaxChannels) throw std::runtime_error("it has too many channels");
}

// Opening a file takes memory for rows of its stated width: before that, its headers alone, of which a file
// of several parts has one each, and an empty one at the end.
void require_readable(const std::string& bytes, const std::string& name) {
  int version = 0;
  if (bytes.size() < kStart) throw std::runtime_error("it ends too early");
  std::memcpy(&version, bytes.data() + 4, 4);
  Source source(bytes, name);
  for (size_t at = kStart; at == kStart || (Imf::isMultiPart(version) && bytes[at] != 0);) {
    const size_t end = require_attributes_fit(bytes, at, version);
    if (end >= bytes.size()) throw std::runtime_error("it ends too early");
    Imf::Header header;
    source.seekg(at);
    header.readFrom(source, version);
    require_readable(header, bytes.size(), name);
    at = end;
  }
}

std::vector<std::string> wanted_channels(const Imf::ChannelList& list) {
  std::vector<std::string> names;
  if (list.findChannel("R") && list.findChannel("G") && list.findChannel("B")) {
    names = {"R", "G", "B"};
    if (list.findChannel("A")) names.push_back("A");
  } else if (list.findChannel("Y")) {
    names = {"Y"};
  } else if (channel_count(list) == 1) {
    names = {list.begin().name()};
  } else {
    throw std::runtime_error("it has neither R, G and B nor one gray channel");
  }
  for (const std::string& name : names)
    if (list[name].xSampling != 1 || list[name].ySampling != 1)
      throw std::runtime_error("its channels are subsampled");
  return names;
}

// The interleaved image of a window, addressed from pixel (0, 0) as the library expects.
Imf::FrameBuffer frame_buffer(Image& image, const std::vector<std::string>& names,
                              const Imath::Box2i& window) {
  const size_t x_step = sizeof(float) * size_t(image.channels), y_step = x_step * size_t(image.width);
  Imf::FrameBuffer buffer;
  for (size_t c = 0; c < names.size(); ++c)
    buffer.insert(names[c], Imf::Slice::Make(Imf::FLOAT, image.data.data() + c, window, x_step, y_step));
  return buffer;
}

Image read_window(Imf::InputFile& file, const Imath::Box2i& window) {
  const std::vector<std::string> names = wanted_channels(file.header().channels());
  Image image(int(width_of(window)), int(height_of(window)), int(names.size()));
  file.setFrameBuffer(frame_buffer(image, names, window));
  file.readPixels(window.min.y, window.max.y);
  return image;
}

Image shift_to_display(const Image& data, const Imath::Box2i& from, const Imath::Box2i& to) {
  Image out(int(width_of(to)), int(height_of(to)), data.channels);
  for (int y = std::max(from.min.y, to.min.y); y <= std::min(from.max.y, to.max.y); ++y)
    for (int x = std::max(from.min.x, to.min.x); x <= std::min(from.max.x, to.max.x); ++x)
      std::copy_n(data.at(x - from.min.x, y - from.min.y), data.channels, out.at(x - to.min.x, y - to.min.y));
  return out;
}

template <class F>
auto reading(const std::string& bytes, const std::string& name, F use) {
  try {
    require_readable(bytes, name);
    Source source(bytes, name);
    Imf::InputFile file(source, 1);
    return use(file);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& e) {
    fail("{} is a broken or unusual EXR: {}. Copy or render it again.", name, e.what());
  }
}

}  // namespace

Image decode_exr(const std::string& bytes, const std::string& name) {
  return reading(bytes, name, [](Imf::InputFile& file) {
    const Imath::Box2i data = file.header().dataWindow(), display = file.header().displayWindow();
    const Image image = read_window(file, data);
    return data == display ? image : shift_to_display(image, data, display);
  });
}

ImageSize exr_size(const std::string& bytes, const std::string& name) {
  return reading(bytes, name, [](Imf::InputFile& file) {
    const Imath::Box2i box = file.header().displayWindow();
    return ImageSize{int(width_of(box)), int(height_of(box))};
  });
}

std::string encode_exr(const Image& image) {
  std::vector<std::string> names{"R", "G", "B", "A"};
  if (image.channels == 1) names = {"Y"};
  if (image.empty() || (image.channels != 1 && image.channels != 3 && image.channels != 4))
    fail("Cannot write an EXR of {} x {} pixels with {} channels.", image.width, image.height,
         image.channels);
  names.resize(size_t(image.channels));
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const std::string& name : names) header.channels().insert(name, Imf::Channel(Imf::FLOAT));
  Image copy = image;  // the library takes pointers to non-const
  Sink sink;
  {
    Imf::OutputFile file(sink, header, 1);  // its destructor writes the table of offsets
    file.setFrameBuffer(frame_buffer(copy, names, header.dataWindow()));
    file.writePixels(image.height);
  }
  return std::move(sink.bytes);
}

}  // namespace cei3d
