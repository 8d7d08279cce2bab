// SPDX-License-Identifier: Apache-2.0
// Memory for kernels: a register of 64 bytes that straddles two cache lines loads at half the speed, and
// std::vector promises 16.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace cei3d {

template <class T>
struct LineAllocator {
  static constexpr std::align_val_t kLine{64};
  using value_type = T;

  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}

  T* allocate(size_t n) { return static_cast<T*>(::operator new(n * sizeof(T), kLine)); }
  void deallocate(T* p, size_t) { ::operator delete(p, kLine); }
  template <class U>
  bool operator==(const LineAllocator<U>&) const {
    return true;
  }
};

// A vector whose first element begins a cache line.
template <class T>
using AlignedVector = std::vector<T, LineAllocator<T>>;

}  // namespace cei3d
