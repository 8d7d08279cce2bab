// SPDX-License-Identifier: Apache-2.0
// Linear layers as register tiles: 4 or 8 outputs times 2 registers of samples share every load. Included
// only by run.cpp.
#pragma once

#include <cstddef>

#include "core/compute/linear.h"

namespace cei3d {

// y[o .. o+R) for the 2 W samples at x: R outputs per tile, W samples per register.
template <int R, class T, int W>
HD void linear_rows(const LinearArgs& a, const float* x, int o, float* y) {
  const float* w = a.weights + size_t(o) * a.weight_stride;
  T s0[R], s1[R];
  for (int r = 0; r < R; ++r) s0[r] = s1[r] = T(a.bias ? a.bias[o + r] : 0.0f);
  for (int i = 0; i < a.in; ++i) {
    const T x0 = load<T>(x + size_t(i) * kPanel), x1 = load<T>(x + size_t(i) * kPanel + W);
    for (int r = 0; r < R; ++r) {
      const T c(w[size_t(r) * a.weight_stride + i]);
      s0[r] = s0[r] + c * x0;
      s1[r] = s1[r] + c * x1;
    }
  }
  for (int r = 0; r < R; ++r) {
    store<T>(y + size_t(o + r) * kPanel, s0[r]);
    store<T>(y + size_t(o + r) * kPanel + W, s1[r]);
  }
}

template <class T, int W>
inline __attribute__((always_inline)) void linear_run(const LinearArgs& a) {
  constexpr int kRows = W == 16 ? 8 : 4;  // AVX-512 has twice the registers
  for (int p = 0; p < a.panels; ++p) {
    for (int s = 0; s < kPanel; s += 2 * W) {
      const float* x = a.x + size_t(p) * a.x_stride * kPanel + s;
      float* y = a.y + size_t(p) * a.y_stride * kPanel + s;
      int o = 0;
      for (; o + kRows <= a.out; o += kRows) linear_rows<kRows, T, W>(a, x, o, y);
      for (; o + 4 <= a.out; o += 4) linear_rows<4, T, W>(a, x, o, y);
      for (; o < a.out; ++o) linear_rows<1, T, W>(a, x, o, y);
    }
  }
}

// d_weights of R outputs x C inputs: products of whole registers are summed over panels, then across the
// lanes.
template <int R, int C, class T, int W>
HD void weight_grad_tile(const LinearWeightGradArgs& a, int o, int i) {
  T sum[R][C];
  for (int r = 0; r < R; ++r)
    for (int c = 0; c < C; ++c) sum[r][c] = T(0.0f);
  for (int p = 0; p < a.panels; ++p) {
    const float* x = a.x + (size_t(p) * a.x_stride + i) * kPanel;
    const float* d = a.d_y + (size_t(p) * a.y_stride + o) * kPanel;
    for (int s = 0; s < kPanel; s += W) {
      T xs[C];
      for (int c = 0; c < C; ++c) xs[c] = load<T>(x + size_t(c) * kPanel + s);
      for (int r = 0; r < R; ++r) {
        const T dr = load<T>(d + size_t(r) * kPanel + s);
        for (int c = 0; c < C; ++c) sum[r][c] = sum[r][c] + dr * xs[c];
      }
    }
  }
  for (int r = 0; r < R; ++r) {
    float* out = a.d_weights + size_t(o + r) * a.weight_stride + i;
    if constexpr (C % 4 == 0)
      for (int c = 0; c < C; c += 4) add_sums4(out + c, sum[r] + c);
    else
      for (int c = 0; c < C; ++c) out[c] += sum_lanes(sum[r][c]);
  }
}

template <int R, class T, int W>
HD void weight_grad_rows(const LinearWeightGradArgs& a, int o, int i, int end) {
  if constexpr (R == 1)
    for (; i + 8 <= end; i += 8) weight_grad_tile<R, 8, T, W>(a, o, i);
  for (; i + 4 <= end; i += 4) weight_grad_tile<R, 4, T, W>(a, o, i);
  for (; i < end; ++i) weight_grad_tile<R, 1, T, W>(a, o, i);
}

template <class T, int W>
inline __attribute__((always_inline)) void bias_grad(const LinearWeightGradArgs& a) {
  for (int o = 0; o < a.out; ++o) {
    T sum(0.0f);
    for (int p = 0; p < a.panels; ++p)
      for (int s = 0; s < kPanel; s += W)
        sum = sum + load<T>(a.d_y + (size_t(p) * a.y_stride + o) * kPanel + s);
    a.d_bias[o] += sum_lanes(sum);
  }
}

// Block sizes in panels and inputs, so that a block stays in the first-level cache while all outputs are
// computed: 32 inputs of a panel are a page, as is one of the cache's 12 ways (48 KiB); two ways are left to
// the outputs. More panels per block mean fewer sums across lanes.
template <class T, int W>
inline __attribute__((always_inline)) void weight_grad_run(const LinearWeightGradArgs& all) {
  constexpr int kPanels = 10, kInputs = 32;
  for (int p = 0; p < all.panels; p += kPanels) {
    LinearWeightGradArgs a = all;
    a.x += size_t(p) * a.x_stride * kPanel;
    a.d_y += size_t(p) * a.y_stride * kPanel;
    a.panels = all.panels - p < kPanels ? all.panels - p : kPanels;
    for (int i = 0; i < a.in; i += kInputs) {
      const int end = i + kInputs < a.in ? i + kInputs : a.in;
      int o = 0;
      for (; o + 4 <= a.out; o += 4) weight_grad_rows<4, T, W>(a, o, i, end);
      for (; o < a.out; ++o) weight_grad_rows<1, T, W>(a, o, i, end);
    }
  }
  if (all.d_bias) bias_grad<T, W>(all);
}

}  // namespace cei3d
