// SPDX-License-Identifier: Apache-2.0
// The same kernels for CUDA: one thread an item. Compiled wherever nvcc is found, so that the kernels stay CUDA-clean.
#include "core/compute/kernels/all.h"

namespace cei3d::cuda {

template <class K>
__global__ void launch(typename K::Args args, int n) {
  const int i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i < n) K::template run<float>(args, i);
}

template <class... K>
void* first_entry(KernelList<K...>) {
  void* entries[] = {reinterpret_cast<void*>(&launch<K>)...};
  return entries[0];
}

void* kernels() { return first_entry(AllKernels{}); }

}  // namespace cei3d::cuda
