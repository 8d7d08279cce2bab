// SPDX-License-Identifier: Apache-2.0
// Values that can be read again, in memory within a number of bytes: what was not used lately is dropped, and
// read when it is needed. For any number of threads.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace cei3d {

class Shelf {
 public:
  class Slot;
  explicit Shelf(size_t max_bytes) : max_bytes_(max_bytes) {}

  // A value that is in memory now. name: of what it is read from; bytes: that it takes. read: makes the same
  // value again.
  static std::shared_ptr<Slot> put(std::shared_ptr<Shelf>, std::string name, size_t bytes,
                                   std::shared_ptr<const void> value,
                                   std::function<std::shared_ptr<const void>()> read);
  // Keeps all values of that name in memory for as long as they are used: what they are read from goes away.
  void keep(const std::string& name);

  size_t bytes() const;  // of the values in memory
  size_t reads() const { return reads_; }

 private:
  void add(Slot&);
  void remove(Slot&);

  size_t max_bytes_, bytes_ = 0;
  std::atomic<size_t> reads_ = 0;
  mutable std::mutex mutex_;
  std::list<Slot*> resident_;  // the one that came last is last
  std::multimap<std::string, std::weak_ptr<Slot>> all_;
};

class Shelf::Slot {
 public:
  ~Slot();
  std::shared_ptr<const void> get();

 private:
  friend class Shelf;
  std::shared_ptr<Shelf> shelf_;
  std::multimap<std::string, std::weak_ptr<Slot>>::iterator place_;
  size_t bytes_ = 0;
  std::function<std::shared_ptr<const void>()> read_;
  std::mutex mutex_;                   // of the members below; never taken before the shelf's
  std::shared_ptr<const void> value_;  // null: dropped
  bool used_ = false;                  // since it was last looked at
  bool kept_ = false;
  bool resident_ = false;  // in the shelf's list; with the shelf's mutex
};

// A value in memory, or one on a shelf. Copies share it.
template <class T>
class Shelved {
 public:
  // Keeps the value in memory for as long as it lives, and not longer than the Shelved.
  class Use {
   public:
    Use(const T* value, std::shared_ptr<const void> owner) : value_(value), owner_(std::move(owner)) {}
    const T& operator*() const { return *value_; }
    const T* operator->() const { return value_; }

   private:
    const T* value_;
    std::shared_ptr<const void> owner_;  // null: the Shelved
  };

  Shelved() = default;
  Shelved(std::nullptr_t) {}
  template <class U>
  Shelved(std::shared_ptr<U> value) : value_(std::move(value)) {}
  // value: is what `read` gives.
  Shelved(std::shared_ptr<Shelf> shelf, const std::string& name, size_t bytes, std::shared_ptr<const T> value,
          std::function<std::shared_ptr<const T>()> read)
      : slot_(Shelf::put(std::move(shelf), name, bytes, std::move(value), std::move(read))) {}

  explicit operator bool() const { return value_ || slot_; }
  Use use() const {
    if (!slot_) return {value_.get(), nullptr};
    std::shared_ptr<const void> owner = slot_->get();
    const T* const value = static_cast<const T*>(owner.get());
    return {value, std::move(owner)};
  }
  Use operator->() const { return use(); }
  std::shared_ptr<const T> share() const {
    return slot_ ? std::static_pointer_cast<const T>(slot_->get()) : value_;
  }

 private:
  std::shared_ptr<const T> value_;
  std::shared_ptr<Shelf::Slot> slot_;
};

}  // namespace cei3d
