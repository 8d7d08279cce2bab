// SPDX-License-Identifier: Apache-2.0
// Numbers as bytes. All files of the program hold little-endian numbers, and memory is copied to and from
// them unchanged. Files that do so include this header, which does not compile for big-endian machines.
#pragma once

#include <bit>
#include <ranges>
#include <span>
#include <string>
#include <type_traits>

namespace cei3d {

static_assert(std::endian::native == std::endian::little,
              "files are little-endian, and their numbers are copied without swapping bytes");

// values: an array, a vector or a span of numbers.
template <std::ranges::contiguous_range R>
void append_bytes(std::string& out, const R& values) {
  using T = std::ranges::range_value_t<R>;
  static_assert(std::is_trivially_copyable_v<T>);
  if (!std::ranges::empty(values))
    out.append(reinterpret_cast<const char*>(std::ranges::data(values)),
               std::ranges::size(values) * sizeof(T));
}

// A single number, or a struct of numbers without gaps.
template <class T>
requires(!std::ranges::range<T>) void append_bytes(std::string& out, const T& value) {
  append_bytes(out, std::span(&value, 1));
}

}  // namespace cei3d
