// SPDX-License-Identifier: Apache-2.0
// Arrays of numbers with names, as pages read them: the length of a JSON head (u32), the head, the arrays,
// each at a multiple of 4 bytes. The head says what the pack holds and, for every array, where it begins
// after the head, its type ("u8", "i8", "u16", "i16", "u32" or "f32") and its shape [rows, columns].
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/json.h"

namespace cei3d {

class Pack {
 public:
  explicit Pack(const char* kind) { head_["kind"] = kind; }

  Json& operator[](const char* key) { return head_[key]; }

  // values: row by row.
  void add(const char* name, const std::vector<uint8_t>& values, size_t columns);
  void add(const char* name, const std::vector<int8_t>& values, size_t columns);
  void add(const char* name, const std::vector<uint16_t>& values, size_t columns);
  void add(const char* name, const std::vector<int16_t>& values, size_t columns);
  void add(const char* name, const std::vector<uint32_t>& values, size_t columns);
  void add(const char* name, const std::vector<float>& values, size_t columns);

  std::string bytes() const;

 private:
  template <class T>
  void append(const char* name, const char* type, const std::vector<T>& values, size_t columns);

  Json head_, arrays_ = Json::object();
  std::string data_;
};

}  // namespace cei3d
