// SPDX-License-Identifier: Apache-2.0
// A page in one file that shows an object: scripts, style and data are inside, and its policy forbids it to
// load anything.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/json_fwd.h"

namespace cei3d {

// Bytes for a page, which finds them as "data-NAME".
struct PageData {
  std::string name;  // letters, digits and _
  std::string bytes;
};

// title: any text. about: what page.js reads of the object: up and from (directions towards the first
// camera), both [3].
std::string object_page(const std::string& title, const Json& about, const std::vector<PageData>& data);

std::string base64(std::string_view bytes);

}  // namespace cei3d
