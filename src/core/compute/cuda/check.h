// SPDX-License-Identifier: Apache-2.0
// What CUDA returns, as errors.
#pragma once

#include <cuda_runtime.h>

#include "core/compute/cuda/failed.h"

namespace cei3d::cuda {

// what: for failed().
inline void check(cudaError_t error, const char* what) {
  if (error != cudaSuccess) failed(what, cudaGetErrorString(error));
}

}  // namespace cei3d::cuda
