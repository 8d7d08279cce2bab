// SPDX-License-Identifier: Apache-2.0
// A cache that keeps the most recently used values within a number of bytes. For one thread at a time; the
// values are shared and outlive the cache.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <list>
#include <memory>
#include <utility>

namespace cei3d {

struct CacheCount {
  size_t found = 0, missed = 0;  // calls of find()
};

// Lookup is linear, by == of keys: for tens of entries, not for thousands.
template <class Key, class Value>
class LruCache {
 public:
  explicit LruCache(size_t max_bytes) : max_bytes_(max_bytes) {}

  // Null when there is none.
  std::shared_ptr<Value> find(const Key& key) {
    const auto it =
        std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.key == key; });
    ++(it == entries_.end() ? count_.missed : count_.found);
    if (it == entries_.end()) return nullptr;
    entries_.splice(entries_.begin(), entries_, it);
    return it->value;
  }

  // Takes the place of a value of the same key. The newest value stays even where it alone is too large.
  std::shared_ptr<Value> put(Key key, std::shared_ptr<Value> value, size_t bytes) {
    std::erase_if(entries_, [&](const Entry& e) {
      if (e.key != key) return false;
      bytes_ -= e.bytes;
      return true;
    });
    entries_.push_front({std::move(key), value, bytes});
    bytes_ += bytes;
    for (; bytes_ > max_bytes_ && entries_.size() > 1; entries_.pop_back()) bytes_ -= entries_.back().bytes;
    return value;
  }

  size_t size() const { return entries_.size(); }
  size_t bytes() const { return bytes_; }
  const CacheCount& count() const { return count_; }

 private:
  struct Entry {
    Key key;
    std::shared_ptr<Value> value;
    size_t bytes;
  };
  std::list<Entry> entries_;  // the one used last first
  size_t max_bytes_, bytes_ = 0;
  CacheCount count_;
};

}  // namespace cei3d
