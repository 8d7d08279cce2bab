// SPDX-License-Identifier: Apache-2.0
#include "engine/project/store.h"

#include <algorithm>
#include <vector>

#include "core/base/error.h"
#include "core/base/file.h"
#include "core/base/hash.h"

namespace cei3d {
namespace fs = std::filesystem;
namespace {

constexpr size_t kHashDigits = 32;

bool is_hash(const std::string& s) {
  return s.size() == kHashDigits && std::all_of(s.begin(), s.end(), [](unsigned char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

}  // namespace

fs::path ObjectStore::path(const std::string& hash) const {
  if (!is_hash(hash)) fail("'{}' is not the name of a stored object; the project is damaged.", hash);
  return root_ / hash.substr(0, 2) / (hash.substr(2) + ".safetensors");
}

std::string ObjectStore::put(const Tensors& tensors) {
  const std::string bytes = tensors_to_bytes(tensors);
  const std::string hash = content_hash(bytes);
  const fs::path file = path(hash);
  std::error_code error;
  // Same name and size: the same object, unless the file is damaged; then writing it again repairs it.
  if (fs::file_size(file, error) == bytes.size() && !error && content_hash(read_file(file)) == hash)
    return hash;
  write_file_atomic(file, bytes);
  return hash;
}

Tensors ObjectStore::get(const std::string& hash) const {
  const fs::path file = path(hash);
  std::error_code error;
  if (!fs::exists(file, error))
    fail("{} is missing; restore it from a copy of the project, or make the project again.", file.string());
  const std::string bytes = read_file(file);
  if (content_hash(bytes) != hash)
    fail(
        "{} is damaged: its bytes are not those that were stored; restore it from a copy of the project, or "
        "make the project again.",
        file.string());
  return tensors_from_bytes(bytes, file.string());
}

void ObjectStore::remove_all_but(const std::set<std::string>& keep,
                                 const std::function<void(const std::string&)>& before) {
  std::error_code error;
  std::vector<fs::path> garbage;
  for (fs::recursive_directory_iterator it(root_, error), end; !error && it != end; it.increment(error)) {
    if (!it->is_regular_file(error)) continue;
    const std::string hash = it->path().parent_path().filename().string() + it->path().stem().string();
    if (keep.count(hash)) continue;
    if (before) before(hash);
    garbage.push_back(it->path());
  }
  for (const fs::path& file : garbage) {
    fs::remove(file, error);
    fs::remove(file.parent_path(), error);  // only when empty
  }
}

}  // namespace cei3d
