// SPDX-License-Identifier: Apache-2.0
#include "apps/server/uploads.h"

#include <algorithm>
#include <cctype>

#include "core/base/file.h"
#include "core/base/hash.h"

namespace cei3d {

std::string plain_file_name(const std::string& name) {
  constexpr size_t kLongest = 80;
  std::string plain;
  for (const unsigned char c : name.substr(name.find_last_of("/\\") + 1))
    if (std::isalnum(c) || c == '.' || c == '_' || c == '-') plain += char(c);
  const size_t first = plain.find_first_not_of('.');
  plain = first == std::string::npos ? "" : plain.substr(first);
  if (plain.size() > kLongest) plain = plain.substr(plain.size() - kLongest);
  return plain.empty() ? "file" : plain;
}

std::string Uploads::add(const std::string& name, const std::string& bytes) {
  const std::string id = content_hash(bytes), plain = plain_file_name(name);
  const std::lock_guard lock(mutex_);
  std::erase_if(files_, [&](const auto& f) { return f.first == id; });
  write_file_atomic(folder_.path() / id / plain, bytes);
  files_.emplace_back(id, plain);
  for (; files_.size() > kMax; files_.pop_front()) {
    std::error_code ignored;
    std::filesystem::remove_all(folder_.path() / files_.front().first, ignored);
  }
  return id;
}

std::filesystem::path Uploads::path(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto it = std::find_if(files_.begin(), files_.end(), [&](const auto& f) { return f.first == id; });
  if (it == files_.end())
    throw Error(ErrorCode::again, "The file that was sent for this is gone; send it again.");
  return folder_.path() / it->first / it->second;
}

std::string Uploads::bytes(const std::string& id) const { return read_file(path(id)); }

}  // namespace cei3d
