// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace cei3d {

// As small as zlib gets it; the same bytes for the same input.
std::string gzip(std::string_view bytes);

}  // namespace cei3d
