// SPDX-License-Identifier: Apache-2.0
// The safetensors format: u64 header length (little endian), JSON header, then the arrays' bytes. Only
// little-endian machines. [huggingface.co/docs/safetensors]
#include "core/base/tensors.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "core/base/bytes.h"
#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

constexpr uint64_t kMaxHeader = 100'000'000;  // the limit that the format's own reader sets

struct Entry {
  std::string name;
  Tensor tensor;
  bool is_float;
  uint64_t begin, end;  // bytes, relative to the end of the header
};

[[noreturn]] void malformed(const std::string& file, const std::string& why) {
  fail(
      "{} is not a usable safetensors file: {}. It may be truncated or from another program; restore or "
      "remake it.",
      file, why);
}

int64_t element_count(const std::vector<int64_t>& shape, const std::string& file, const std::string& name) {
  int64_t n = 1;
  for (const int64_t d : shape)
    if (d < 0 || __builtin_mul_overflow(n, d, &n)) malformed(file, "impossible shape of '" + name + "'");
  return n;
}

uint64_t as_size(const Json& j, const std::string& file, const std::string& name) {
  // The parser makes 1.0 a float and negative numbers signed, so this is exactly "a non-negative integer that
  // fits".
  if (!j.is_number_unsigned() || j.get<uint64_t>() > uint64_t(std::numeric_limits<int64_t>::max()))
    malformed(file, "'" + name + "' holds something that is not a size");
  return j.get<uint64_t>();
}

Entry parse_entry(const std::string& name, const Json& j, uint64_t data_size, const std::string& file) {
  if (!j.is_object() || !j.contains("dtype") || !j.contains("shape") || !j.contains("data_offsets"))
    malformed(file, "'" + name + "' lacks dtype, shape or data_offsets");
  const Json &dtype = j["dtype"], &shape = j["shape"], &offsets = j["data_offsets"];
  if (dtype != "F32" && dtype != "U8") malformed(file, "'" + name + "' has a dtype other than F32 and U8");
  if (!shape.is_array() || !offsets.is_array() || offsets.size() != 2)
    malformed(file, "'" + name + "' has a malformed shape or data_offsets");
  Entry e;
  e.name = name;
  e.is_float = dtype == "F32";
  for (const Json& d : shape) e.tensor.shape.push_back(int64_t(as_size(d, file, name)));
  e.begin = as_size(offsets[0], file, name);
  e.end = as_size(offsets[1], file, name);
  if (e.begin > e.end || e.end > data_size)
    malformed(file, "'" + name + "' reaches beyond the end of the file");
  const int64_t count = element_count(e.tensor.shape, file, name);
  const uint64_t item = e.is_float ? 4 : 1;
  if ((e.end - e.begin) % item != 0 || (e.end - e.begin) / item != uint64_t(count))
    malformed(file, "the shape of '" + name + "' does not match its bytes");
  return e;
}

void require_tiling(std::vector<const Entry*> entries, uint64_t data_size, const std::string& file) {
  std::sort(entries.begin(), entries.end(), [](const Entry* a, const Entry* b) {
    return std::pair(a->begin, a->end) < std::pair(b->begin, b->end);
  });
  uint64_t position = 0;
  for (const Entry* e : entries) {
    if (e->begin != position) malformed(file, "the arrays overlap or leave a gap before '" + e->name + "'");
    position = e->end;
  }
  if (position != data_size) malformed(file, "there are bytes after the last array");
}

void append(std::string& out, const Tensor& t) {
  append_bytes(out, t.f32);
  append_bytes(out, t.u8);
}

void require_consistent(const std::string& name, const Tensor& t) {
  const int64_t n = element_count(t.shape, "the output", name);
  if ((!t.f32.empty() && !t.u8.empty()) || uint64_t(n) != t.f32.size() + t.u8.size())
    fail("Cannot store array '{}': its shape does not match its values (an error in the program).", name);
}

// Limits the depth of nesting: the destructor of a deeply nested JSON value is recursive.
Json parse_header(const char* text, uint64_t size, const std::string& file) {
  const auto limit_depth = [&](int depth, Json::parse_event_t, Json&) {
    if (depth > 8) malformed(file, "its header is nested too deep");
    return true;
  };
  Json header;
  try {
    header = Json::parse(text, text + size, limit_depth);
  } catch (const nlohmann::json::exception&) {
    malformed(file, "its header is not JSON");
  }
  if (!header.is_object()) malformed(file, "its header is not a JSON object");
  return header;
}

}  // namespace

std::string tensors_to_bytes(const Tensors& tensors) {
  Json header = Json::object();
  uint64_t position = 0;
  for (const auto& [name, t] : tensors) {
    require_consistent(name, t);
    const bool is_u8 = !t.u8.empty();
    const uint64_t size = t.u8.size() + t.f32.size() * 4;
    header[name] = {
        {"dtype", is_u8 ? "U8" : "F32"}, {"shape", t.shape}, {"data_offsets", {position, position + size}}};
    position += size;
  }
  std::string text = header.dump();
  text.append((8 - text.size() % 8) % 8, ' ');  // aligns the arrays
  const uint64_t length = text.size();
  std::string out;
  out.reserve(8 + text.size() + position);
  append_bytes(out, length);
  out += text;
  for (const auto& [name, t] : tensors) append(out, t);
  return out;
}

Tensors tensors_from_bytes(const std::string& bytes, const std::string& file) {
  uint64_t length = 0;
  if (bytes.size() < 8) malformed(file, "it is too short");
  std::memcpy(&length, bytes.data(), 8);
  if (length > kMaxHeader || length > bytes.size() - 8)
    malformed(file, "its header reaches beyond the end of the file");
  const Json header = parse_header(bytes.data() + 8, length, file);
  const char* data = bytes.data() + 8 + length;
  const uint64_t data_size = bytes.size() - 8 - length;

  std::vector<Entry> entries;
  for (const auto& [name, j] : header.items())
    if (name != "__metadata__") entries.push_back(parse_entry(name, j, data_size, file));
  std::vector<const Entry*> order;
  for (const Entry& e : entries) order.push_back(&e);
  require_tiling(order, data_size, file);

  Tensors tensors;
  for (Entry& e : entries) {
    const uint64_t size = e.end - e.begin;
    if (e.is_float) {
      e.tensor.f32.resize(size / 4);
      if (size > 0) std::memcpy(e.tensor.f32.data(), data + e.begin, size);
    } else {
      e.tensor.u8.assign(data + e.begin, data + e.end);
    }
    if (!tensors.emplace(e.name, std::move(e.tensor)).second)
      malformed(file, "the name '" + e.name + "' comes twice");
  }
  return tensors;
}

Tensors read_tensors(const std::filesystem::path& path) {
  return tensors_from_bytes(read_file(path), path.string());
}

void write_tensors(const std::filesystem::path& path, const Tensors& tensors) {
  write_file_atomic(path, tensors_to_bytes(tensors));
}

namespace {

constexpr const char* kRemedy = "The file is damaged: restore it from a copy, or make again what it holds.";

const Tensor& of_shape(const Tensors& in, const std::string& name, const std::vector<int64_t>& shape) {
  const Tensor& t = require_tensor(in, name);
  if (t.shape != shape)
    fail("Array '{}' has the shape {} instead of {}. {}", name, fmt::join(t.shape, "x"),
         fmt::join(shape, "x"), kRemedy);
  return t;
}

void require_count(const std::string& name, size_t count, const std::vector<int64_t>& shape) {
  size_t wanted = 1;
  for (const int64_t n : shape) wanted *= size_t(n);
  if (count != wanted) fail("Array '{}' has {} numbers instead of {}. {}", name, count, wanted, kRemedy);
}

}  // namespace

const Tensor& require_tensor(const Tensors& in, const std::string& name) {
  const auto it = in.find(name);
  if (it == in.end()) fail("Array '{}' is missing. {}", name, kRemedy);
  return it->second;
}

const Tensor& require_tensor(const Tensors& in, const std::string& name, const std::vector<int64_t>& shape) {
  const Tensor& t = of_shape(in, name, shape);
  if (!t.u8.empty()) fail("Array '{}' holds bytes instead of floats. {}", name, kRemedy);
  require_count(name, t.f32.size(), shape);
  return t;
}

const Tensor& require_bytes(const Tensors& in, const std::string& name, const std::vector<int64_t>& shape) {
  const Tensor& t = of_shape(in, name, shape);
  if (!t.f32.empty()) fail("Array '{}' holds floats instead of bytes. {}", name, kRemedy);
  require_count(name, t.u8.size(), shape);
  return t;
}

}  // namespace cei3d
