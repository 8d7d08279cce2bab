// SPDX-License-Identifier: Apache-2.0
// Names of the files that belong to another one.
#pragma once

#include <filesystem>
#include <string>

namespace cei3d {

// Characters other than letters, digits, '.', '-' and '_' become '_', for the formats in which names end at
// spaces.
std::string plain_name(std::string name);

// "folder/object.obj" and "_normal.png": "folder/object_normal.png", as a plain_name().
std::filesystem::path beside(const std::filesystem::path& file, const std::string& ending);

// The name alone, for use in a file in the same folder.
std::string uri_of(const std::filesystem::path& file);

}  // namespace cei3d
