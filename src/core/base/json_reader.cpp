// SPDX-License-Identifier: Apache-2.0
#include "core/base/json_reader.h"

#include <algorithm>

#include "core/base/name_distance.h"

namespace cei3d {
namespace {

std::string shortened(const Json& j) {
  constexpr size_t kMaxLetters = 40;
  const std::string text = j.dump(-1, ' ', false, Json::error_handler_t::replace);
  return text.size() <= kMaxLetters ? text : text.substr(0, kMaxLetters) + "...";
}

// A name of a thing that may begin a sentence, inside of one.
std::string inside(std::string what) {
  if (what.starts_with("The ")) what[0] = 't';
  return what;
}

}  // namespace

JsonReader::JsonReader(const Json& object, std::string what) : object_(object), what_(std::move(what)) {
  if (!object.is_object()) fail("{} is damaged: {} is where an object belongs.", what_, shortened(object));
}

bool JsonReader::has(const char* key) {
  if (std::find(read_.begin(), read_.end(), key) == read_.end()) read_.emplace_back(key);
  return object_.contains(key);
}

const Json& JsonReader::member(const char* key) {
  if (!has(key)) fail("{} lacks the key '{}'.", what_, key);
  return *object_.find(key);
}

const Json& JsonReader::array(const char* key) {
  const Json& j = member(key);
  if (!j.is_array()) wrong_type(key, j, "a list");
  return j;
}

JsonReader JsonReader::object(const char* key) {
  const Json& j = member(key);
  if (!j.is_object()) wrong_type(key, j, "an object");
  return {j, fmt::format("'{}' of {}", key, inside(what_))};
}

void JsonReader::finish() const {
  for (const auto& [key, value] : object_.items()) {
    if (std::find(read_.begin(), read_.end(), key) != read_.end()) continue;
    const std::string near = nearest_name(key, read_);
    fail("{} has the unknown key '{}'{}. Correct it, or update cei3d if a newer version wrote it.", what_,
         key, near.empty() ? "" : "; the nearest known key is '" + near + "'");
  }
}

void JsonReader::wrong_type(const char* key, const Json& found, const std::string& wanted) const {
  fail("{}: the key '{}' holds {} where {} belongs.", what_, key, shortened(found), wanted);
}

}  // namespace cei3d
