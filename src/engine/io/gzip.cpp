// SPDX-License-Identifier: Apache-2.0
#include "engine/io/gzip.h"

#include <zlib.h>

#include <limits>

#include "core/base/error.h"

namespace cei3d {

std::string gzip(std::string_view bytes, Packing packing) {
  constexpr int kGzipWindow = 15 + 16, kMemory = 9;
  z_stream z{};
  if (bytes.size() > std::numeric_limits<uInt>::max())
    fail("{} bytes are too many to compress at once.", bytes.size());
  const int level = packing == Packing::fast ? Z_BEST_SPEED : Z_BEST_COMPRESSION;
  if (deflateInit2(&z, level, Z_DEFLATED, kGzipWindow, kMemory, Z_DEFAULT_STRATEGY) != Z_OK)
    fail("There is no memory to compress {} bytes.", bytes.size());
  std::string out(deflateBound(&z, uLong(bytes.size())), '\0');
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // NOLINT: zlib does not write there
  z.avail_in = uInt(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = uInt(out.size());
  const int state = deflate(&z, Z_FINISH);
  out.resize(z.total_out);
  deflateEnd(&z);
  if (state != Z_STREAM_END) fail("zlib failed to compress {} bytes.", bytes.size());
  return out;
}

}  // namespace cei3d
