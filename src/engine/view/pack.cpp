// SPDX-License-Identifier: Apache-2.0
#include "engine/view/pack.h"

#include "core/base/bytes.h"
#include "core/base/json.h"

namespace cei3d {
namespace {

constexpr size_t kAlignment = 4;

void pad(std::string& bytes, char with) {
  bytes.resize((bytes.size() + kAlignment - 1) / kAlignment * kAlignment, with);
}

}  // namespace

template <class T>
void Pack::append(const char* name, const char* type, const std::vector<T>& values, size_t columns) {
  arrays_[name] = {{"at", data_.size()}, {"type", type}, {"shape", {values.size() / columns, columns}}};
  append_bytes(data_, values);
  pad(data_, '\0');
}

void Pack::add(const char* name, const std::vector<uint8_t>& v, size_t columns) {
  append(name, "u8", v, columns);
}
void Pack::add(const char* name, const std::vector<int8_t>& v, size_t columns) {
  append(name, "i8", v, columns);
}
void Pack::add(const char* name, const std::vector<uint16_t>& v, size_t columns) {
  append(name, "u16", v, columns);
}
void Pack::add(const char* name, const std::vector<int16_t>& v, size_t columns) {
  append(name, "i16", v, columns);
}
void Pack::add(const char* name, const std::vector<uint32_t>& v, size_t columns) {
  append(name, "u32", v, columns);
}
void Pack::add(const char* name, const std::vector<float>& v, size_t columns) {
  append(name, "f32", v, columns);
}

std::string Pack::bytes() const {
  Json head = head_;
  head["arrays"] = arrays_;
  std::string text = head.dump();
  pad(text, ' ');
  std::string out;
  append_bytes(out, uint32_t(text.size()));
  return out + text + data_;
}

}  // namespace cei3d
