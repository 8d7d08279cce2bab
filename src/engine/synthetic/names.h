// SPDX-License-Identifier: Apache-2.0
// Lists of names in messages.
#pragma once

#include <string>
#include <vector>

namespace cei3d {

// "ball, box, teapot"
inline std::string listed(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

}  // namespace cei3d
