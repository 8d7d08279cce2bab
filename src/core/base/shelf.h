// SPDX-License-Identifier: Apache-2.0
// A cache of values that can be read again, for example from files, with a limit of bytes. Beyond the limit
// it drops values that were not used lately; they are read again when they are needed. Safe for several
// threads.
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
#include <vector>

namespace cei3d {

class Shelf {
 public:
  class Slot;
  explicit Shelf(size_t max_bytes) : max_bytes_(max_bytes) {}

  // Adds a value. name: of what it is read from, for keep(); bytes: its size in memory. read: returns an
  // equal value.
  static std::shared_ptr<Slot> put(std::shared_ptr<Shelf>, std::string name, size_t bytes,
                                   std::shared_ptr<const void> value,
                                   std::function<std::shared_ptr<const void>()> read);
  // Keeps all values of that name in memory for as long as their slots live; call it before what they are
  // read from is deleted.
  void keep(const std::string& name);
  void limit(size_t max_bytes);  // from now on

  size_t bytes() const;                    // of the values in memory
  size_t reads() const { return reads_; }  // how often a dropped value was read again

 private:
  void add(Slot&);  // its value is in memory now; may drop others
  using Values = std::vector<std::shared_ptr<const void>>;
  Values drop(const Slot* but);  // what is beyond the limit; the mutex is locked
  void remove(Slot&);            // the slot is destroyed

  size_t max_bytes_, bytes_ = 0;
  std::atomic<size_t> reads_ = 0;
  mutable std::mutex mutex_;
  std::list<Slot*> resident_;  // slots with their value in memory; the first is considered for dropping first
  std::multimap<std::string, std::weak_ptr<Slot>> all_;  // by name
};

// The place of one value.
class Shelf::Slot {
 public:
  ~Slot();
  std::shared_ptr<const void> get();  // reads the value if it was dropped; throws what `read` throws

 private:
  friend class Shelf;
  std::shared_ptr<Shelf> shelf_;
  std::multimap<std::string, std::weak_ptr<Slot>>::iterator place_;
  size_t bytes_ = 0;
  std::function<std::shared_ptr<const void>()> read_;
  std::mutex mutex_;                   // of value_, used_, kept_; if both are locked, after the shelf's mutex
  std::shared_ptr<const void> value_;  // null: dropped
  bool used_ = false;                  // since add() last considered dropping it
  bool kept_ = false;                  // never dropped
  bool resident_ = false;              // in the list of the shelf; guarded by the shelf's mutex
};

// A value in memory that is never dropped, or a value on a shelf. Copies share it.
template <class T>
class Shelved {
 public:
  // Access to the value, which is not dropped meanwhile. Must not outlive the Shelved.
  class Use {
   public:
    Use(const T* value, std::shared_ptr<const void> owner) : value_(value), owner_(std::move(owner)) {}
    const T& operator*() const { return *value_; }
    const T* operator->() const { return value_; }

   private:
    const T* value_;
    std::shared_ptr<const void> owner_;  // of the value; null: the Shelved owns it
  };

  Shelved() = default;
  Shelved(std::nullptr_t) {}
  template <class U>
  Shelved(std::shared_ptr<U> value) : value_(std::move(value)) {}
  // On a shelf, see Shelf::put(). value: equal to what `read` returns.
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
