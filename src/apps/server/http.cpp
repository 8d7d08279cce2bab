// SPDX-License-Identifier: Apache-2.0
#include "apps/server/http.h"

#include <algorithm>
#include <cctype>

namespace cei3d {

std::optional<std::string> decoded(const std::string& text) {
  std::string out;
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    if (i + 2 >= text.size() || !std::isxdigit((unsigned char)text[i + 1]) ||
        !std::isxdigit((unsigned char)text[i + 2]))
      return std::nullopt;
    out += char(std::stoi(text.substr(i + 1, 2), nullptr, 16));
    i += 2;
  }
  return out;
}

std::optional<std::string> HttpRequest::parameter(const std::string& key) const {
  for (size_t at = 0; at < query.size();) {
    const size_t end = std::min(query.find('&', at), query.size());
    const std::string pair = query.substr(at, end - at);
    if (pair.starts_with(key + "=")) return decoded(pair.substr(key.size() + 1));
    at = end + 1;
  }
  return std::nullopt;
}

}  // namespace cei3d
