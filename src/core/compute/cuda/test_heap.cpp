// SPDX-License-Identifier: Apache-2.0
// Blocks of 128 << k bytes, of which the first 64 say how large a block is; freed ones are kept by size.
#include "core/compute/cuda/test_heap.h"

#include <bit>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <new>

#include "core/compute/cuda/check.h"

namespace cei3d::cuda {
namespace {

constexpr size_t kHeap = size_t(256) << 20, kHeader = 64;  // bytes; a header keeps lines of the cache whole

struct Block {
  int size_class;
  Block* next;  // while it is free
};

class Heap {
 public:
  void open() {
    void *host = nullptr, *seen = nullptr;
    check(cudaHostAlloc(&host, kHeap, cudaHostAllocMapped | cudaHostAllocPortable),
          "host memory for the card");
    check(cudaHostGetDevicePointer(&seen, host, 0), "the card's address of host memory");
    if (seen != host) failed("host memory", "the card has another address for it");
    const std::lock_guard lock(mutex_);
    begin_ = next_ = static_cast<char*>(host);
  }
  bool is_open() const { return begin_ != nullptr; }
  bool owns(const void* p) const {
    return begin_ && static_cast<const char*>(p) >= begin_ && static_cast<const char*>(p) < begin_ + kHeap;
  }
  void* take(size_t size) {
    const int k = std::bit_width((size + kHeader - 1) / 128);
    const size_t bytes = size_t(128) << k;
    const std::lock_guard lock(mutex_);
    Block* block = free_[k];
    if (block) {
      free_[k] = block->next;
    } else {
      if (bytes > size_t(begin_ + kHeap - next_)) return nullptr;
      block = new (next_) Block;
      next_ += bytes;
    }
    block->size_class = k;
    return reinterpret_cast<char*>(block) + kHeader;
  }
  void give_back(void* p) {
    Block* block = reinterpret_cast<Block*>(static_cast<char*>(p) - kHeader);
    const std::lock_guard lock(mutex_);
    block->next = free_[block->size_class];
    free_[block->size_class] = block;
  }

 private:
  std::mutex mutex_;
  char *begin_ = nullptr, *next_ = nullptr;
  Block* free_[64] = {};
};

constinit Heap heap;

void* take(size_t size, size_t alignment) {
  void* p = nullptr;
  if (heap.is_open() && alignment <= kHeader) {
    p = heap.take(size);
    if (!p) std::fputs("The heap of the CUDA tests is full; kHeap in test_heap.cpp\n", stderr);
  } else {
    p = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  }
  if (!p) throw std::bad_alloc();
  return p;
}
void give_back(void* p) {
  if (heap.owns(p))
    heap.give_back(p);
  else
    std::free(p);
}

}  // namespace

void open_heap() { heap.open(); }

}  // namespace cei3d::cuda

void* operator new(size_t size) { return cei3d::cuda::take(size, __STDCPP_DEFAULT_NEW_ALIGNMENT__); }
void* operator new(size_t size, std::align_val_t alignment) {
  return cei3d::cuda::take(size, size_t(alignment));
}
void operator delete(void* p) noexcept { cei3d::cuda::give_back(p); }
void operator delete(void* p, size_t) noexcept { cei3d::cuda::give_back(p); }
void operator delete(void* p, std::align_val_t) noexcept { cei3d::cuda::give_back(p); }
void operator delete(void* p, size_t, std::align_val_t) noexcept { cei3d::cuda::give_back(p); }
