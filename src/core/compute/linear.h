// SPDX-License-Identifier: Apache-2.0
// Linear layers over panels: an operation that each backend implements itself instead of as a kernel.
//
// A panel holds 32 samples, feature-major: [feature][32]. A batch is a sequence of panels, `stride` rows of
// 32 floats apart.
#pragma once

#include "core/math/scalar.h"

namespace cei3d {

inline constexpr int kPanel = 32;  // samples per panel
// n rounded up to whole panels.
HD constexpr int padded_to_panels(int n) { return (n + kPanel - 1) / kPanel * kPanel; }

// y[o] = sum_i weights[o][i] x[i] (+ bias[o]) for every sample of every panel.
struct LinearArgs {
  int panels, in, out;
  const float* x;        // [panels][x_stride][32]; rows [0, in) are read
  int x_stride;          // rows from one panel to the next
  const float* weights;  // [out][weight_stride]
  int weight_stride;     // floats from one output's row to the next
  const float* bias;     // [out] or null
  float* y;              // [panels][y_stride][32]; rows [0, out) are written
  int y_stride;
};

// d_weights[o][i] += sum over samples of d_y[o] x[i]; d_bias[o] += sum over samples of d_y[o].
struct LinearWeightGradArgs {
  int panels, in, out;
  const float* x;
  int x_stride;
  const float* d_y;
  int y_stride;
  float* d_weights;  // [out][weight_stride]
  int weight_stride;
  float* d_bias;  // [out] or null
};

}  // namespace cei3d
