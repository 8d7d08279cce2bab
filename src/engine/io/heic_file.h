// SPDX-License-Identifier: Apache-2.0
// HEIC photographs of telephones, read by the program heif-convert.
#pragma once

#include <filesystem>

namespace cei3d {

bool is_heic(const std::filesystem::path& path);  // by its name: .heic or .heif, any case

// Makes the JPEG `to`, whole or not at all. Errors: the program is not installed, with the package that has
// it; it cannot read the file, with what it said.
void convert_heic(const std::filesystem::path& from, const std::filesystem::path& to);

}  // namespace cei3d
