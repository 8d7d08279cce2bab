// SPDX-License-Identifier: Apache-2.0
// Linear layers as tiles in shared memory, of which every thread computes a part in registers. Included by
// files that nvcc compiles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "core/compute/cuda/check.h"
#include "core/compute/linear.h"

namespace cei3d::cuda {

// A row of 32 samples, or as many outputs as fit, in pieces of 16 bytes.
__device__ inline float4 load4(const float* p) { return *reinterpret_cast<const float4*>(p); }
__device__ inline void store4(float* p, float4 v) { *reinterpret_cast<float4*>(p) = v; }

// A block computes 8 R outputs of 4 panels, a thread R outputs of 8 samples: 4 in a row, and the 4 that are
// two panels further.
template <int R>
struct LinearTile {
  static constexpr int kThreads = 128, kPanels = 4, kSamples = kPanels * kPanel, kInputs = 16,
                       kOutputs = 8 * R;
  float x[kInputs][kSamples];
  float w[kInputs][kOutputs + 4];  // 4 more: rows of the weights are written as columns

  // Inputs from `input` on; zeros beyond the arrays.
  __device__ void load_x(const LinearArgs& a, int input) {
#pragma unroll
    for (int round = 0; round < kInputs * kSamples / 4 / kThreads; ++round) {
      const int piece = round * kThreads + int(threadIdx.x);
      const int i = piece / (kSamples / 4), s = piece % (kSamples / 4) * 4;
      const int panel = int(blockIdx.x) * kPanels + s / kPanel;
      float4 v = make_float4(0, 0, 0, 0);
      if (input + i < a.in && panel < a.panels)
        v = load4(a.x + (size_t(panel) * a.x_stride + input + i) * kPanel + s % kPanel);
      store4(&x[i][s], v);
    }
  }
  __device__ void load_w(const LinearArgs& a, int input) {
#pragma unroll
    for (int round = 0; round < kInputs * kOutputs / kThreads; ++round) {
      const int at = round * kThreads + int(threadIdx.x);
      const int i = at % kInputs, o = at / kInputs, output = int(blockIdx.y) * kOutputs + o;
      w[i][o] =
          input + i < a.in && output < a.out ? a.weights[size_t(output) * a.weight_stride + input + i] : 0;
    }
  }
  // Adds the products of the first `inputs` inputs of the tile, rounded up to 8.
  __device__ void accumulate(int inputs, float (&sum)[R][8]) const {
    const int s = int(threadIdx.x) % 16 * 4, o = int(threadIdx.x) / 16 * R;
    for (int first = 0; first < inputs; first += 8)
#pragma unroll
      for (int k = 0; k < 8; ++k) {
        const int i = first + k;
        const float4 a = load4(&x[i][s]), b = load4(&x[i][s + kSamples / 2]);
        const float xs[8] = {a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w};
#pragma unroll
        for (int r = 0; r < R; ++r)
#pragma unroll
          for (int c = 0; c < 8; ++c) sum[r][c] += w[i][o + r] * xs[c];
      }
  }
};

template <int R>
__device__ inline void store_linear(const LinearArgs& a, const float (&sum)[R][8]) {
  using Tile = LinearTile<R>;
  const int s = int(threadIdx.x) % 16 * 4;
  const int output = int(blockIdx.y) * Tile::kOutputs + int(threadIdx.x) / 16 * R;
#pragma unroll
  for (int half = 0; half < 2; ++half) {
    const int panel = int(blockIdx.x) * Tile::kPanels + half * Tile::kPanels / 2 + s / kPanel;
    if (panel >= a.panels) continue;
#pragma unroll
    for (int r = 0; r < R; ++r) {
      if (output + r >= a.out) continue;
      const float* v = sum[r] + 4 * half;
      store4(a.y + (size_t(panel) * a.y_stride + output + r) * kPanel + s % kPanel,
             make_float4(v[0], v[1], v[2], v[3]));
    }
  }
}

template <int R>
__global__ void __launch_bounds__(128, 3) linear_tile(const __grid_constant__ LinearArgs a) {
  using Tile = LinearTile<R>;
  __shared__ __align__(16) Tile tile;
  const int output = int(blockIdx.y) * Tile::kOutputs + int(threadIdx.x) / 16 * R;
  float sum[R][8];
#pragma unroll
  for (int r = 0; r < R; ++r)
#pragma unroll
    for (int c = 0; c < 8; ++c) sum[r][c] = a.bias && output + r < a.out ? a.bias[output + r] : 0;
  for (int input = 0; input < a.in; input += Tile::kInputs) {
    tile.load_x(a, input);
    tile.load_w(a, input);
    __syncthreads();
    tile.accumulate(min(Tile::kInputs, a.in - input), sum);
    __syncthreads();
  }
  store_linear<R>(a, sum);
}

// A block sums 8 RO outputs times 8 RI inputs over some panels, a thread RO times RI of them: every eighth
// output and input, so that threads beside each other read rows that lie in different banks of the memory.
template <int RO, int RI>
struct WeightGradTile {
  static constexpr int kThreads = 64, kOutputs = 8 * RO, kInputs = 8 * RI, kRow = kPanel + 4;
  float d_y[kOutputs][kRow];
  float x[kInputs][kRow];

  // Rows of a panel; zeros from row `in_use` on.
  template <int N>
  __device__ static void load(const float* panel, int in_use, float (&rows)[N][kRow]) {
#pragma unroll
    for (int round = 0; round < N * kPanel / 4 / kThreads; ++round) {
      const int piece = round * kThreads + int(threadIdx.x);
      const int row = piece / (kPanel / 4), s = piece % (kPanel / 4) * 4;
      store4(&rows[row][s], row < in_use ? load4(panel + size_t(row) * kPanel + s) : make_float4(0, 0, 0, 0));
    }
  }
  __device__ void accumulate(float (&sum)[RO][RI]) const {
    const int i = int(threadIdx.x) % 8, o = int(threadIdx.x) / 8;
#pragma unroll 2
    for (int s = 0; s < kPanel; s += 4) {
      float4 xs[RI];
#pragma unroll
      for (int c = 0; c < RI; ++c) xs[c] = load4(&x[i + 8 * c][s]);
#pragma unroll
      for (int r = 0; r < RO; ++r) {
        const float4 d = load4(&d_y[o + 8 * r][s]);
#pragma unroll
        for (int c = 0; c < RI; ++c)
          sum[r][c] += d.x * xs[c].x + d.y * xs[c].y + d.z * xs[c].z + d.w * xs[c].w;
      }
    }
  }
  // The sum of the output that belongs to this thread.
  __device__ float output_sum() const {
    float sum = 0;
    for (int s = 0; s < kPanel; s += 4) {
      const float4 d = load4(&d_y[threadIdx.x][s]);
      sum += (d.x + d.y) + (d.z + d.w);
    }
    return sum;
  }
};

template <int RO, int RI>
__device__ inline void add_weight_grad(const LinearWeightGradArgs& a, int output, int input,
                                       const float (&sum)[RO][RI]) {
  const int o = output + int(threadIdx.x) / 8, i = input + int(threadIdx.x) % 8;
#pragma unroll
  for (int r = 0; r < RO; ++r)
#pragma unroll
    for (int c = 0; c < RI; ++c)
      if (o + 8 * r < a.out && i + 8 * c < a.in)
        atomicAdd(a.d_weights + size_t(o + 8 * r) * a.weight_stride + i + 8 * c, sum[r][c]);
}

template <int RO, int RI>
__global__ void __launch_bounds__(64, 6)
    weight_grad_tile(const __grid_constant__ LinearWeightGradArgs a, int panels_per_block) {
  using Tile = WeightGradTile<RO, RI>;
  __shared__ __align__(16) Tile tile;
  const int output = int(blockIdx.y) * Tile::kOutputs, input = int(blockIdx.z) * Tile::kInputs;
  const int begin = int(blockIdx.x) * panels_per_block, end = min(begin + panels_per_block, a.panels);
  const bool adds_bias = a.d_bias && blockIdx.z == 0 && threadIdx.x < Tile::kOutputs;
  float sum[RO][RI] = {}, bias = 0;
  for (int p = begin; p < end; ++p) {
    Tile::load(a.d_y + (size_t(p) * a.y_stride + output) * kPanel, a.out - output, tile.d_y);
    Tile::load(a.x + (size_t(p) * a.x_stride + input) * kPanel, a.in - input, tile.x);
    __syncthreads();
    tile.accumulate(sum);
    if (adds_bias) bias += tile.output_sum();
    __syncthreads();
  }
  add_weight_grad<RO, RI>(a, output, input, sum);
  if (adds_bias && output + int(threadIdx.x) < a.out) atomicAdd(a.d_bias + output + threadIdx.x, bias);
}

// Calls body with the number of rows per thread as a constant: the smallest tile that holds `rows`, or the
// largest.
template <class Body>
void with_rows(int rows, const Body& body) {
  if (rows <= 16)
    body(std::integral_constant<int, 2>{});
  else if (rows <= 32)
    body(std::integral_constant<int, 4>{});
  else
    body(std::integral_constant<int, 8>{});
}
inline int parts(int n, int size) { return (n + size - 1) / size; }
inline void check_alignment(const float* p, const char* what) {
  if (reinterpret_cast<uintptr_t>(p) % 16 != 0) failed(what, "an array is not aligned to 16 bytes");
}

inline void enqueue_linear(const LinearArgs& a) {
  if (a.panels <= 0 || a.out <= 0) return;
  check_alignment(a.x, "linear layer");
  check_alignment(a.y, "linear layer");
  with_rows(a.out, [&](auto rows) {
    using Tile = LinearTile<rows()>;
    const dim3 blocks(unsigned(parts(a.panels, Tile::kPanels)), unsigned(parts(a.out, Tile::kOutputs)));
    linear_tile<rows()><<<blocks, Tile::kThreads>>>(a);
  });
  check(cudaGetLastError(), "linear layer");
}

inline void enqueue_linear_weight_grad(const LinearWeightGradArgs& a) {
  constexpr int kBlocks = 1024;  // enough for every card; more would mean more additions to the same weights
  if (a.panels <= 0 || a.out <= 0 || a.in <= 0) return;
  check_alignment(a.x, "weight gradient");
  check_alignment(a.d_y, "weight gradient");
  const int panels_per_block = parts(a.panels, kBlocks);
  with_rows(a.out, [&](auto outputs) {
    with_rows(a.in, [&](auto inputs) {
      using Tile = WeightGradTile<decltype(outputs)::value, decltype(inputs)::value>;
      const dim3 blocks(unsigned(parts(a.panels, panels_per_block)), unsigned(parts(a.out, Tile::kOutputs)),
                        unsigned(parts(a.in, Tile::kInputs)));
      weight_grad_tile<decltype(outputs)::value, decltype(inputs)::value>
          <<<blocks, Tile::kThreads>>>(a, panels_per_block);
    });
  });
  check(cudaGetLastError(), "weight gradient");
}

}  // namespace cei3d::cuda
