// SPDX-License-Identifier: Apache-2.0
// The files of src/web, which are part of the program.
#pragma once

#include <span>
#include <string_view>

namespace cei3d {

struct PageFile {
  std::string_view name;    // "renderer.js"; "page.joined.js": the modules of the exported page as one script
  std::string_view bytes;   // UTF-8
  std::string_view sha256;  // in hexadecimal digits
};

std::span<const PageFile> page_files();
const PageFile& page_file(std::string_view name);  // error: there is none of that name

}  // namespace cei3d
