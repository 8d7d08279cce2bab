// SPDX-License-Identifier: Apache-2.0
// Takes back what was begun if the rest of it fails.
#pragma once

#include <functional>
#include <utility>

namespace cei3d {

// Calls `undo`, which must not throw, at the end of its scope unless keep() was called.
class Rollback {
 public:
  explicit Rollback(std::function<void()> undo) : undo_(std::move(undo)) {}
  ~Rollback() {
    if (undo_) undo_();
  }
  Rollback(const Rollback&) = delete;
  Rollback& operator=(const Rollback&) = delete;
  void keep() { undo_ = nullptr; }

 private:
  std::function<void()> undo_;
};

}  // namespace cei3d
