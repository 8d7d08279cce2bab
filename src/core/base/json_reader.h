// SPDX-License-Identifier: Apache-2.0
// Reads a JSON object key by key and rejects unknown keys: finish() throws an error that names a key that was
// not read, and the nearest key that was.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/base/error.h"
#include "core/base/json.h"

namespace cei3d {

class JsonReader {
 public:
  // The object must outlive the reader. what: what it is, in errors: a file, "the parameters of edit
  // 0001-paint". Error: it is not an object.
  JsonReader(const Json& object, std::string what);

  // Errors: missing, of another type, out of the type's range.
  template <class T>
  T require(const char* key) {
    return value<T>(member(key), key);
  }
  template <class T>
  std::optional<T> optional(const char* key) {
    return has(key) ? std::optional(value<T>(*object_.find(key), key)) : std::nullopt;
  }
  template <class T>
  T optional(const char* key, T otherwise) {
    return optional<T>(key).value_or(std::move(otherwise));
  }

  bool has(const char* key);            // the key counts as read
  const Json& member(const char* key);  // as it is; error when it is missing
  const Json& array(const char* key);   // error also when it is no array
  JsonReader object(const char* key);   // a reader of its own, to be finished by itself
  template <size_t N>
  std::array<double, N> numbers(const char* key) {  // an array of N numbers
    std::array<double, N> out;
    const Json& list = array(key);
    if (list.size() != N) wrong_type(key, list, fmt::format("{} numbers", N));
    for (size_t i = 0; i < N; ++i) out[i] = value<double>(list[i], key);
    return out;
  }

  // Error: a key that has not been read.
  void finish() const;
  const std::string& what() const { return what_; }

 private:
  template <class T>
  T value(const Json& j, const char* key) const;
  [[noreturn]] void wrong_type(const char* key, const Json& found, const std::string& wanted) const;

  const Json& object_;
  std::string what_;
  std::vector<std::string> read_;  // keys that were asked for, also those that are missing
};

template <class T>
bool fits_into(const Json& j) {
  if (j.is_number_unsigned()) return j.get<uint64_t>() <= uint64_t(std::numeric_limits<T>::max());
  if (!j.is_number_integer()) return false;
  const auto n = j.get<int64_t>();
  if constexpr (std::is_signed_v<T>)
    return n >= std::numeric_limits<T>::min() && n <= std::numeric_limits<T>::max();
  else
    return n >= 0 && uint64_t(n) <= uint64_t(std::numeric_limits<T>::max());
}

template <class T>
T JsonReader::value(const Json& j, const char* key) const {
  if constexpr (std::is_same_v<T, bool>) {
    if (!j.is_boolean()) wrong_type(key, j, "true or false");
  } else if constexpr (std::is_integral_v<T>) {
    if (!fits_into<T>(j))
      wrong_type(key, j, std::is_signed_v<T> ? "a whole number" : "a whole number, not negative,");
  } else if constexpr (std::is_floating_point_v<T>) {
    if (!j.is_number()) wrong_type(key, j, "a number");
  } else {
    static_assert(std::is_same_v<T, std::string>);
    if (!j.is_string()) wrong_type(key, j, "a text");
  }
  return j.get<T>();
}

}  // namespace cei3d
