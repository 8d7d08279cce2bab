// SPDX-License-Identifier: Apache-2.0
#include "engine/io/npy.h"

#include <cctype>
#include <cstring>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/file.h"

namespace cei3d {
namespace {

[[noreturn]] void broken(const std::string& name, const char* why) {
  fail("{} is not a usable .npy array: {}.", name, why);
}

// The text after "'key':" in the header, a Python dictionary in a fixed notation.
std::string value_of_key(const std::string& header, const std::string& key, const std::string& name) {
  const size_t at = header.find("'" + key + "'");
  const size_t colon = at == std::string::npos ? at : header.find(':', at);
  if (colon == std::string::npos) broken(name, "its header lacks a key");
  const size_t start = header.find_first_not_of(' ', colon + 1);
  return start == std::string::npos ? "" : header.substr(start);
}

std::vector<int64_t> parse_shape(const std::string& text, const std::string& name) {
  std::vector<int64_t> shape;
  if (text.empty() || text[0] != '(') broken(name, "its shape is malformed");
  for (size_t i = 1; i < text.size() && text[i] != ')';) {
    if (!std::isdigit(static_cast<unsigned char>(text[i]))) {
      if (text[i] != ',' && text[i] != ' ') broken(name, "its shape is malformed");
      ++i;
      continue;
    }
    int64_t n = 0;
    for (; i < text.size() && std::isdigit(static_cast<unsigned char>(text[i])); ++i)
      if (__builtin_mul_overflow(n, int64_t(10), &n) || __builtin_add_overflow(n, int64_t(text[i] - '0'), &n))
        broken(name, "its shape is impossible");
    shape.push_back(n);
  }
  return shape;
}

// values: [rows][columns]
std::vector<double> transposed(const std::vector<double>& values, int64_t rows, int64_t columns) {
  std::vector<double> out(values.size());
  for (int64_t r = 0; r < rows; ++r)
    for (int64_t c = 0; c < columns; ++c) out[size_t(c * rows + r)] = values[size_t(r * columns + c)];
  return out;
}

}  // namespace

std::string encode_npy(std::span<const float> values, int64_t rows, int64_t columns) {
  if (uint64_t(rows) * uint64_t(columns) != values.size())
    fail("Cannot write {} values as {} x {}.", values.size(), rows, columns);
  std::string header =
      fmt::format("{{'descr': '<f4', 'fortran_order': False, 'shape': ({}, {}), }}", rows, columns);
  header.append((64 - (10 + header.size() + 1) % 64) % 64, ' ');
  header += '\n';
  std::string out("\x93NUMPY\x01\x00", 8);
  out += char(header.size() & 255);
  out += char(header.size() >> 8);
  out += header;
  append_bytes(out, values);
  return out;
}

void write_npy(const std::filesystem::path& path, std::span<const float> values, int64_t rows,
               int64_t columns) {
  write_file_atomic(path, encode_npy(values, rows, columns));
}

NpyArray decode_npy(const std::string& bytes, const std::string& name) {
  if (bytes.size() < 12 || bytes.compare(0, 6, "\x93NUMPY") != 0) broken(name, "it does not start as one");
  const bool wide = bytes[6] >= 2;  // versions 2 and 3: a 4-byte header length
  uint32_t length = uint8_t(bytes[8]) | uint32_t(uint8_t(bytes[9])) << 8;
  if (wide) length |= uint32_t(uint8_t(bytes[10])) << 16 | uint32_t(uint8_t(bytes[11])) << 24;
  const size_t start = wide ? 12 : 10;
  if (length > bytes.size() - start) broken(name, "it ends too early");
  const std::string header = bytes.substr(start, length);
  const std::string type = value_of_key(header, "descr", name).substr(0, 5);
  if (type != "'<f4'" && type != "'<f8'") broken(name, "its values are neither float32 nor float64");
  const bool fortran = value_of_key(header, "fortran_order", name).rfind("False", 0) != 0;

  NpyArray array;
  array.shape = parse_shape(value_of_key(header, "shape", name), name);
  int64_t count = 1;
  for (const int64_t n : array.shape)
    if (__builtin_mul_overflow(count, n, &count)) broken(name, "its shape is impossible");
  const size_t item = type == "'<f4'" ? 4 : 8, have = bytes.size() - start - length;
  if (have % item != 0 || have / item != uint64_t(count)) broken(name, "its shape does not match its bytes");
  const char* data = bytes.data() + start + length;
  array.data.resize(size_t(count));
  for (size_t i = 0; i < array.data.size(); ++i) {
    float narrow = 0;
    if (item == 4)
      std::memcpy(&narrow, data + 4 * i, 4), array.data[i] = double(narrow);
    else
      std::memcpy(&array.data[i], data + 8 * i, 8);
  }
  if (fortran && array.shape.size() > 2) broken(name, "it has more than two dimensions in Fortran order");
  if (fortran && array.shape.size() == 2) array.data = transposed(array.data, array.shape[1], array.shape[0]);
  return array;
}

NpyArray read_npy(const std::filesystem::path& path) { return decode_npy(read_file(path), path.string()); }

}  // namespace cei3d
