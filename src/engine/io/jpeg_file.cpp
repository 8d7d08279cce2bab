// SPDX-License-Identifier: Apache-2.0
#include "engine/io/jpeg_file.h"

#include <turbojpeg.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>

#include "core/base/error.h"
#include "engine/io/image_limits.h"

namespace cei3d {
namespace {

struct CloseHandle {
  void operator()(void* handle) const { tjDestroy(handle); }
};
using Handle = std::unique_ptr<void, CloseHandle>;

[[noreturn]] void broken(const std::string& name, void* handle) {
  fail("{} is a broken or unusual JPEG: {}. Copy it again, or convert it to PNG.", name,
       tjGetErrorStr2(handle));
}

const unsigned char* data_of(const std::string& bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

ImageSize read_header(void* handle, const std::string& bytes, const std::string& name) {
  ImageSize size;
  int subsampling = 0, space = TJCS_YCbCr;
  const int status = tjDecompressHeader3(handle, data_of(bytes), bytes.size(), &size.width, &size.height,
                                         &subsampling, &space);
  if (space == TJCS_CMYK || space == TJCS_YCCK)  // known even where the library refuses the file
    fail("{} is a JPEG of printing inks (CMYK). Export the photograph as RGB (sRGB) instead.", name);
  if (status != 0 || size.width < 1 || size.height < 1)  // cut before its frame header is no error to it
    broken(name, handle);
  return readable_size(size.width, size.height, bytes.size(), name);
}

}  // namespace

ImageSize jpeg_size(const std::string& bytes, const std::string& name) {
  const Handle handle(tjInitDecompress());
  return read_header(handle.get(), bytes, name);
}

Image decode_jpeg(const std::string& bytes, const std::string& name) {
  const Handle handle(tjInitDecompress());
  const ImageSize size = read_header(handle.get(), bytes, name);
  std::unique_ptr<uint8_t[]> data(new uint8_t[size_t(size.width) * size.height * 3]);
  const int status = tjDecompress2(handle.get(), data_of(bytes), bytes.size(), data.get(), size.width, 0,
                                   size.height, TJPF_RGB, TJFLAG_ACCURATEDCT);
  // Decoding survives most damage with a warning. Only a missing end certainly spoils pixels without one.
  const bool fatal = tjGetErrorCode(handle.get()) == TJERR_FATAL ||
                     std::strstr(tjGetErrorStr2(handle.get()), "remature end") != nullptr;
  if (status != 0 && fatal) broken(name, handle.get());
  Image image(size.width, size.height, 3);
  for (size_t i = 0; i < image.data.size(); ++i) image.data[i] = float(data[i]) / 255.0f;
  return image;
}

std::string encode_jpeg(const Image& image, int quality) {
  if (image.channels != 3 || image.empty()) fail("Cannot write a JPEG with {} channels.", image.channels);
  std::string rgb(image.data.size(), '\0');
  for (size_t i = 0; i < rgb.size(); ++i)
    rgb[i] = char(uint8_t(std::clamp(image.data[i], 0.0f, 1.0f) * 255 + 0.5f));
  const Handle handle(tjInitCompress());
  unsigned char* out = nullptr;
  unsigned long size = 0;
  const int status = tjCompress2(handle.get(), data_of(rgb), image.width, 0, image.height, TJPF_RGB, &out,
                                 &size, TJSAMP_444, quality, TJFLAG_ACCURATEDCT);
  const std::string bytes(reinterpret_cast<const char*>(out), status == 0 ? size : 0);
  tjFree(out);
  if (status != 0) fail("Cannot make a JPEG: {}.", tjGetErrorStr2(handle.get()));
  return bytes;
}

}  // namespace cei3d
