// SPDX-License-Identifier: Apache-2.0
// Launches of kernels. Included by files that nvcc compiles.
#pragma once

#include <typeinfo>

#include "core/compute/cuda/check.h"
#include "core/compute/kernels/all.h"

namespace cei3d::cuda {

template <class K>
__global__ void run_items(const __grid_constant__ typename K::Args args, int n) {
  const int i = int(blockIdx.x * blockDim.x + threadIdx.x);
  if (i < n) K::template run<float>(args, i);
}

// Puts a launch of kernel K in line and returns before it is done.
template <class K>
void enqueue(const typename K::Args& args, int n) {
  constexpr int kThreads = 128;  // few, because gradients of lobes take 100 registers each
  if (n <= 0) return;
  run_items<K><<<(n + kThreads - 1) / kThreads, kThreads>>>(args, n);
  check(cudaGetLastError(), typeid(K).name());
}

}  // namespace cei3d::cuda
