// SPDX-License-Identifier: Apache-2.0
// The machine that kernels run on. A CPU device runs a launch on the calling thread; threads come from
// cutting work into chunks with parallel_for. A CUDA device (core/compute/cuda/device.h), which only the
// programs of cmake/cuda.cmake have, runs it on the card and returns when it is done. Devices have no state
// and can be shared by threads.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/compute/linear.h"

namespace cei3d {

// The place of kernel K in every launch table; defined in kernels/list.h, which the header of each kernel
// includes.
template <class K>
constexpr int kernel_index();

// What one instruction set offers: compiled from cpu/run.cpp, or from cuda/run.cu.
struct LaunchTable {
  const char* name;  // "cpu/scalar", "cpu/avx2", "cpu/avx512", "cuda"
  int width;         // samples per register
  void (*const* kernels)(const void* args, int n);
  void (*linear)(const LinearArgs&);
  void (*linear_weight_grad)(const LinearWeightGradArgs&);
  // Loops that the caller times. Each returns how many operations it has done.
  double (*fma_peak)();                                      // floating-point operations in registers
  double (*gather_peak)(const float* pairs, uint32_t mask);  // random 8-byte gathers from mask + 1 pairs
  double (*scatter_peak)(float* pairs, uint32_t mask);       // additions to random ones of mask + 1 pairs
};

class Device {
 public:
  explicit Device(const LaunchTable& table) : table_(table), name_(table.name) {}
  const std::string& name() const { return name_; }
  int width() const { return table_.width; }

  // Runs kernel K on items [0, n). Arrays must be padded to a multiple of 32 items. The caller includes the
  // kernel's header (core/compute/kernels/).
  template <class K>
  void launch(const typename K::Args& args, int n) const {
    table_.kernels[kernel_index<K>()](&args, n);
  }
  void linear(const LinearArgs& a) const { table_.linear(a); }
  void linear_weight_grad(const LinearWeightGradArgs& a) const { table_.linear_weight_grad(a); }
  double fma_peak() const { return table_.fma_peak(); }
  double gather_peak(const float* pairs, uint32_t mask) const { return table_.gather_peak(pairs, mask); }
  double scatter_peak(float* pairs, uint32_t mask) const { return table_.scatter_peak(pairs, mask); }

 private:
  const LaunchTable& table_;
  std::string name_;
};

// spec: "auto" or "cpu" (the widest instruction set this processor has), "cpu/scalar", "cpu/avx2",
// "cpu/avx512", or the name of another of all_devices(). Errors: usage error for anything else, or for an
// instruction set this processor lacks.
Device make_device(std::string_view spec = "auto");

// Every CPU device this processor can run; the scalar one, the reference of parity tests, first. Last, in
// programs that are built with CUDA and where there is a card, the CUDA device.
std::vector<Device> all_devices();

}  // namespace cei3d
