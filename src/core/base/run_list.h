// SPDX-License-Identifier: Apache-2.0
// A list that is read from its beginning, in less memory where neighboring elements have often the same bits:
// a value is kept once for a run of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <vector>

namespace cei3d {

template <class T>
class RunList {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  // At most 2^32 - 1 elements.
  void push_back(const T& value) {
    if (values_.empty() || std::memcmp(&values_.back(), &value, sizeof value) != 0) {
      values_.push_back(value);
      ends_.push_back(uint32_t(size()));
    }
    ++ends_.back();
  }
  void shrink_to_fit() {
    values_.shrink_to_fit();
    ends_.shrink_to_fit();
  }
  size_t size() const { return ends_.empty() ? 0 : ends_.back(); }
  size_t bytes() const { return values_.size() * sizeof(T) + ends_.size() * sizeof(uint32_t); }

  // Must not be asked for more elements than there are, and not outlive the list.
  class Reader {
   public:
    explicit Reader(const RunList& list) : list_(list) {}
    const T& next() {
      if (i_++ == list_.ends_[run_]) ++run_;
      return list_.values_[run_];
    }

   private:
    const RunList& list_;
    size_t i_ = 0, run_ = 0;
  };

 private:
  std::vector<T> values_;       // #runs
  std::vector<uint32_t> ends_;  // #runs, the index of the element after the run
};

}  // namespace cei3d
