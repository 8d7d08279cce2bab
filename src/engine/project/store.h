// SPDX-License-Identifier: Apache-2.0
// Immutable tensors by content: objects/ab/cdef....safetensors, where abcdef... is the hash of the file's
// bytes.
#pragma once

#include <filesystem>
#include <functional>
#include <set>
#include <string>

#include "core/base/tensors.h"

namespace cei3d {

class ObjectStore {
 public:
  explicit ObjectStore(std::filesystem::path root) : root_(std::move(root)) {}

  std::string put(const Tensors&);  // returns the hash; an existing file is not written again
  // Errors: the object is missing, or its bytes do not match its hash.
  Tensors get(const std::string& hash) const;
  // before: is called before an object is removed.
  void remove_all_but(const std::set<std::string>& keep,
                      const std::function<void(const std::string&)>& before = {});

 private:
  std::filesystem::path path(const std::string& hash) const;
  std::filesystem::path root_;
};

}  // namespace cei3d
