// SPDX-License-Identifier: Apache-2.0
// Content hashes: names of objects in a project's store. Not cryptographic.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace cei3d {

// XXH3, 128 bits, as 32 lower-case hexadecimal digits (canonical byte order).
std::string content_hash(std::string_view bytes);

// Spreads the bits of a number: the last step of SplitMix64.
constexpr uint64_t mixed(uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace cei3d
