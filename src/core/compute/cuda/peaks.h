// SPDX-License-Identifier: Apache-2.0
// Loops that show what the card can do at most, for a caller who times them. Each returns how many operations
// it has put in line. Included by files that nvcc compiles.
#pragma once

#include "core/compute/cuda/check.h"
#include "core/math/scalar.h"

namespace cei3d::cuda {

constexpr int kPeakThreads = 256;

// As many blocks as fill the card several times.
inline int peak_blocks() {
  int device = 0, processors = 0;
  check(cudaGetDevice(&device), "the number of the card");
  check(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device), "multiprocessors");
  return 16 * processors;
}

// So that the compiler does not leave the sum out: it cannot know that no sum is ever this large.
__device__ inline void pretend_to_use(float sum) {
  if (sum == 1e30f) __trap();
}

template <int kChains>
__global__ void fma_loop(int rounds) {
  float s[kChains];
  for (int k = 0; k < kChains; ++k) s[k] = float(threadIdx.x + k);
  for (int i = 0; i < rounds; ++i)
#pragma unroll
    for (int k = 0; k < kChains; ++k) s[k] = s[k] * 0.999f + 0.5f;
  float sum = 0;
  for (int k = 0; k < kChains; ++k) sum += s[k];
  pretend_to_use(sum);
}
// Floating-point operations.
inline double enqueue_fma_peak() {
  constexpr int kRounds = 1 << 13, kChains = 8;
  const int blocks = peak_blocks();
  fma_loop<kChains><<<blocks, kPeakThreads>>>(kRounds);
  check(cudaGetLastError(), "multiply-add peak");
  return 2.0 * kChains * kRounds * kPeakThreads * blocks;
}

// Pseudo-random places of a table of mask + 1 entries, different ones in every thread.
struct RandomPlaces {
  uint32_t at, mask;
  __device__ explicit RandomPlaces(uint32_t mask_in)
      : at((blockIdx.x * blockDim.x + threadIdx.x) * 2654435761u), mask(mask_in) {}
  __device__ uint32_t next() {
    at = at * 1664525u + 1013904223u;
    return (at ^ (at * 805459861u)) & mask;
  }
};

constexpr int kPeakPlaces = 128;  // that a thread visits

template <int kPlaces>
__global__ void gather_loop(const float* pairs, uint32_t mask) {
  RandomPlaces places(mask);
  float sum = 0;
#pragma unroll 8
  for (int i = 0; i < kPlaces; ++i) {
    float a, b;
    gather2(pairs, places.next(), a, b);
    sum += a + b;
  }
  pretend_to_use(sum);
}
// Gathers of pairs of floats.
inline double enqueue_gather_peak(const float* pairs, uint32_t mask) {
  const int blocks = peak_blocks();
  gather_loop<kPeakPlaces><<<blocks, kPeakThreads>>>(pairs, mask);
  check(cudaGetLastError(), "gather peak");
  return double(kPeakPlaces) * kPeakThreads * blocks;
}

template <int kPlaces>
__global__ void scatter_loop(float* pairs, uint32_t mask) {
  RandomPlaces places(mask);
  for (int i = 0; i < kPlaces; ++i) scatter_add2(pairs, places.next(), 1e-6f, -1e-6f);
}
// Additions to pairs of floats.
inline double enqueue_scatter_peak(float* pairs, uint32_t mask) {
  const int blocks = peak_blocks();
  scatter_loop<kPeakPlaces><<<blocks, kPeakThreads>>>(pairs, mask);
  check(cudaGetLastError(), "scatter peak");
  return double(kPeakPlaces) * kPeakThreads * blocks;
}

}  // namespace cei3d::cuda
