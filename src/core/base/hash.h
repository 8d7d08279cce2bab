// SPDX-License-Identifier: Apache-2.0
// Content hashes: names of objects in a project's store. Not cryptographic.
#pragma once

#include <string>
#include <string_view>

namespace cei3d {

// XXH3, 128 bits, as 32 lower-case hexadecimal digits (canonical byte order).
std::string content_hash(std::string_view bytes);

}  // namespace cei3d
