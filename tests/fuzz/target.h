// SPDX-License-Identifier: Apache-2.0
// What libFuzzer targets share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "core/base/error.h"

// Reads input by read(). Errors are expected: any other exception is a finding.
template <class Read>
int fuzz_bytes(const uint8_t* data, size_t size, Read read) {
  try {
    read(std::string(reinterpret_cast<const char*>(data), size));
  } catch (const cei3d::Error&) {
  }
  return 0;
}

// Reads input whose first byte chooses one of `kinds` kinds of the rest, by read(kind, rest).
template <class Read>
int fuzz_kinds(const uint8_t* data, size_t size, int kinds, Read read) {
  if (size < 1) return 0;
  return fuzz_bytes(data + 1, size - 1, [&](const std::string& rest) { read(data[0] % kinds, rest); });
}
