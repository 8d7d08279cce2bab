// SPDX-License-Identifier: Apache-2.0
// For tests: reads what Pack has written.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include "core/base/json.h"

namespace cei3d {

struct ReadPack {
  Json head;
  std::string data;

  explicit ReadPack(const std::string& bytes) {
    uint32_t size = 0;
    std::memcpy(&size, bytes.data(), sizeof size);
    head = Json::parse(bytes.substr(sizeof size, size));
    data = bytes.substr(sizeof size + size);
  }
  template <class T>
  std::vector<T> array(const char* name) const {
    const Json& j = head.at("arrays").at(name);
    std::vector<T> out(j.at("shape")[0].get<size_t>() * j.at("shape")[1].get<size_t>());
    std::memcpy(out.data(), data.data() + j.at("at").get<size_t>(), out.size() * sizeof(T));
    return out;
  }
};

}  // namespace cei3d
