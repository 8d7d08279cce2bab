// SPDX-License-Identifier: Apache-2.0
// Reusable work memory: the object returned last is handed out first, while it is still in cache.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace cei3d {

template <class T>
class Pool {
 public:
  explicit Pool(std::function<std::unique_ptr<T>()> make) : make_(std::move(make)) {}

  // Calls body with an object that no other thread has meanwhile.
  template <class F>
  void with(F body) {
    std::unique_ptr<T> object = take();
    body(*object);
    const std::lock_guard lock(mutex_);
    free_.push_back(std::move(object));
  }

 private:
  std::unique_ptr<T> take() {
    {
      const std::lock_guard lock(mutex_);
      if (!free_.empty()) {
        std::unique_ptr<T> object = std::move(free_.back());
        free_.pop_back();
        return object;
      }
    }
    return make_();
  }
  std::function<std::unique_ptr<T>()> make_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> free_;
};

}  // namespace cei3d
