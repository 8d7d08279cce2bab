// SPDX-License-Identifier: Apache-2.0
// Compressed bytes, with the header of gzip.
#pragma once

#include <string>
#include <string_view>

namespace cei3d {

// smallest: as zlib gets it; fast: some 100 MB a second. The same bytes for the same input.
enum class Packing { smallest, fast };
std::string gzip(std::string_view bytes, Packing = Packing::smallest);

}  // namespace cei3d
