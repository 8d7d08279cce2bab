// SPDX-License-Identifier: Apache-2.0
// Every kernel for CUDA, as a launch table: what cpu/run.cpp is for an instruction set.
#include <fstream>

#include "core/compute/cuda/device.h"
#include "core/compute/cuda/launch.h"
#include "core/compute/cuda/linear.h"
#include "core/compute/cuda/peaks.h"

namespace cei3d::cuda {
namespace {

// Errors of the kernel itself, such as an address that the card cannot reach, show only here.
void finish(const char* what) { check(cudaDeviceSynchronize(), what); }

template <class K>
void launch(const void* args, int n) {
  enqueue<K>(*static_cast<const typename K::Args*>(args), n);
  finish(typeid(K).name());
}

template <class List>
struct Table;
template <class... K>
struct Table<KernelList<K...>> {
  static constexpr void (*entries[])(const void*, int) = {&launch<K>...};
};

void linear(const LinearArgs& a) {
  enqueue_linear(a);
  finish("linear layer");
}
void linear_weight_grad(const LinearWeightGradArgs& a) {
  enqueue_linear_weight_grad(a);
  finish("weight gradient");
}

double fma_peak() {
  const double flops = enqueue_fma_peak();
  finish("multiply-add peak");
  return flops;
}
double gather_peak(const float* pairs, uint32_t mask) {
  const double pairs_read = enqueue_gather_peak(pairs, mask);
  finish("gather peak");
  return pairs_read;
}
double scatter_peak(float* pairs, uint32_t mask) {
  const double pairs_added = enqueue_scatter_peak(pairs, mask);
  finish("scatter peak");
  return pairs_added;
}

}  // namespace

extern const LaunchTable table;
const LaunchTable table{
    "cuda", 1, Table<AllKernels>::entries, linear, linear_weight_grad, fma_peak, gather_peak, scatter_peak};

std::string reason_for_no_card() {
  int count = 0;
  const cudaError_t error = cudaGetDeviceCount(&count);
  if (error != cudaSuccess) return cudaGetErrorString(error);
  return count > 0 ? "" : "CUDA finds no card";
}

Card card() {
  int device = 0, runtime = 0;
  cudaDeviceProp properties;
  check(cudaGetDevice(&device), "the number of the card");
  check(cudaGetDeviceProperties(&properties, device), "properties of the card");
  check(cudaRuntimeGetVersion(&runtime), "version of CUDA");
  std::string driver;
  std::ifstream("/sys/module/nvidia/version") >> driver;
  return {properties.name, driver.empty() ? "unknown" : driver, properties.multiProcessorCount, runtime,
          10 * properties.major + properties.minor};
}

}  // namespace cei3d::cuda
