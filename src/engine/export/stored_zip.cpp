// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "engine/export/usdz.h"

namespace cei3d {
namespace {

constexpr size_t kAlignment = 64, kLocalHeader = 30;

uint32_t crc32(std::string_view bytes) {
  static const std::array<uint32_t, 256> table = [] {
    std::array<uint32_t, 256> t{};
    for (uint32_t i = 0; i < 256; ++i) {
      t[i] = i;
      for (int k = 0; k < 8; ++k) t[i] = t[i] >> 1 ^ (t[i] & 1 ? 0xedb88320u : 0u);
    }
    return t;
  }();
  uint32_t crc = ~0u;
  for (const char c : bytes) crc = table[(crc ^ uint8_t(c)) & 255] ^ crc >> 8;
  return ~crc;
}

// An extra field of the local header that fills it up to the alignment: identifier, length, zeros.
std::string padding(size_t header_end) {
  size_t n = (kAlignment - header_end % kAlignment) % kAlignment;
  if (n == 0) return {};
  if (n < 4) n += kAlignment;  // an extra field has at least 4 bytes
  std::string out;
  append_bytes(out, std::array<uint16_t, 2>{0x1986, uint16_t(n - 4)});
  out.append(n - 4, '\0');
  return out;
}

// The fields that local headers and the central directory share, from "version needed" on.
std::string shared_fields(const FileBytes& file, uint16_t extra) {
  constexpr uint16_t kVersion = 10, kFlags = 0, kStored = 0, kTime = 0, kDate = 0x21;  // 1980-01-01
  const std::string name = file.path.string();
  std::string out;
  append_bytes(out, std::array<uint16_t, 5>{kVersion, kFlags, kStored, kTime, kDate});
  const uint32_t size = uint32_t(file.bytes.size());
  append_bytes(out, std::array<uint32_t, 3>{crc32(file.bytes), size, size});
  append_bytes(out, std::array<uint16_t, 2>{uint16_t(name.size()), extra});
  return out;
}

}  // namespace

std::string stored_zip(std::span<const FileBytes> files) {
  std::string out, directory;
  for (const FileBytes& f : files) {
    const std::string name = f.path.string(), pad = padding(out.size() + kLocalHeader + name.size());
    append_bytes(directory, uint32_t(0x02014b50));
    append_bytes(directory, uint16_t(10));  // made by
    directory += shared_fields(f, 0);
    append_bytes(directory, std::array<uint16_t, 3>{0, 0, 0});  // comment, disk, attributes
    append_bytes(directory, std::array<uint32_t, 2>{0, uint32_t(out.size())});
    directory += name;
    append_bytes(out, uint32_t(0x04034b50));
    out += shared_fields(f, uint16_t(pad.size())) + name + pad + f.bytes;
  }
  if (out.size() > 0xf0000000u)
    fail("Less than 4 GB fit into an archive; write fewer faces, a smaller texture or fewer frames.");
  const uint32_t start = uint32_t(out.size());
  out += directory;
  append_bytes(out, uint32_t(0x06054b50));
  const uint16_t n = uint16_t(files.size());
  append_bytes(out, std::array<uint16_t, 4>{0, 0, n, n});
  append_bytes(out, std::array<uint32_t, 2>{uint32_t(directory.size()), start});
  append_bytes(out, uint16_t(0));  // comment
  return out;
}

}  // namespace cei3d
