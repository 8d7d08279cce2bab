// SPDX-License-Identifier: Apache-2.0
#include "core/base/parse_json.h"

namespace cei3d {

bool nested_too_deep(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"') quoted = !quoted;
    if (quoted && c == '\\') ++i;
    if (quoted) continue;
    if ((c == '[' || c == '{') && ++depth > kMaxJsonDepth) return true;
    if (c == ']' || c == '}') --depth;
  }
  return false;
}

Json parse_json(std::string_view text) {
  if (nested_too_deep(text)) return Json::value_t::discarded;
  return Json::parse(text, nullptr, false);
}

}  // namespace cei3d
