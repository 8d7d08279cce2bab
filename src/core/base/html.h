// SPDX-License-Identifier: Apache-2.0
// Text for HTML.
#pragma once

#include <string>

namespace cei3d {

// Text as it stands between tags and in attributes of HTML.
inline std::string html_escaped(const std::string& text) {
  std::string out;
  for (const char c : text)
    out += c == '&'   ? "&amp;"
           : c == '<' ? "&lt;"
           : c == '>' ? "&gt;"
           : c == '"' ? "&quot;"
                      : std::string(1, c);
  return out;
}

}  // namespace cei3d
