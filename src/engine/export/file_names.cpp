// SPDX-License-Identifier: Apache-2.0
#include "engine/export/file_names.h"

#include <cctype>

namespace cei3d {

std::string plain_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '.' && c != '-') c = '_';
  return name;
}

std::filesystem::path beside(const std::filesystem::path& file, const std::string& ending) {
  return file.parent_path() / (plain_name(file.stem().string()) + ending);
}

std::string uri_of(const std::filesystem::path& file) { return file.filename().string(); }

}  // namespace cei3d
