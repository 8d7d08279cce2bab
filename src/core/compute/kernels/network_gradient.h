// SPDX-License-Identifier: Apache-2.0
// The spatial gradient of output 0 of a network, and how a loss of it reaches the network: what lies between
// the linear layers (docs/method.md#values-with-gradients).
#pragma once

#include "core/compute/kernel.h"
#include "core/compute/kernels/panel.h"

namespace cei3d {

// Back through an activation: d_z = first d_h, with `first` the derivative of the activation there.
struct GradientStep {
  struct Args {
    const float *d_h, *first;
    float* d_z;
    int h_stride;  // the others have `rows` rows per panel
    int rows;
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    for (int r = 0; r < a.rows; ++r) {
      const size_t at = panel_at(i, 1, 0, a.rows, r);
      store<T>(a.d_z + at, load<T>(a.first + at) * load<T>(a.d_h + panel_at(i, 1, 0, a.h_stride, r)));
    }
  }
};

// The adjoint of GradientStep. From the derivatives t of a loss by d_z it makes those by d_h, first t, and
// those by z, second d_h t, with `second` the second derivative of the activation.
struct GradientStepGrad {
  struct Args {
    const float *d_h, *first, *second;
    float* t;      // by d_z on entry, by d_h on return
    float* d_z;    // by z, written
    int h_stride;  // of d_h and t; the others have `rows` rows per panel
    int rows;
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    for (int r = 0; r < a.rows; ++r) {
      const size_t at = panel_at(i, 1, 0, a.rows, r), h = panel_at(i, 1, 0, a.h_stride, r);
      const T t = load<T>(a.t + h);
      store<T>(a.d_z + at, t * load<T>(a.second + at) * load<T>(a.d_h + h));
      store<T>(a.t + h, t * load<T>(a.first + at));
    }
  }
};

// Back through an activation whose input has a derivative from elsewhere, too: d = first d + d_z.
struct ActivateGradPlus {
  struct Args {
    const float *first, *d_z;
    float* d;
    int d_stride;  // the others have `rows` rows per panel
    int rows;
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    for (int r = 0; r < a.rows; ++r) {
      const size_t at = panel_at(i, 1, 0, a.rows, r);
      float* d = a.d + panel_at(i, 1, 0, a.d_stride, r);
      store<T>(d, load<T>(d) * load<T>(a.first + at) + load<T>(a.d_z + at));
    }
  }
};

// From the derivatives by the network's input to those by the point: y_c = sum over rows of d_input dx_c.
struct PointGradient {
  struct Args {
    const float* x;        // [panels * 4][inputs][32]: jets of the input
    const float* d_input;  // [panels][inputs][32]
    float* y;              // [panels * 4][outputs][32]; row 0 of columns 1 to 3 is written
    int inputs, outputs;
    int rows;  // of the input that are in use
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    Vec3<T> sum{T(0.0f), T(0.0f), T(0.0f)};
    for (int r = 0; r < a.rows; ++r) {
      const T d = load<T>(a.d_input + panel_at(i, 1, 0, a.inputs, r));
      for (int c = 0; c < 3; ++c) sum[c] = sum[c] + d * load<T>(a.x + panel_at(i, 4, 1 + c, a.inputs, r));
    }
    for (int c = 0; c < 3; ++c) store<T>(a.y + panel_at(i, 4, 1 + c, a.outputs, 0), sum[c]);
  }
};

// The adjoint of PointGradient.
struct PointGradientGrad {
  struct Args {
    const float* x;
    const float* d_input;
    const float* d_y;  // [panels * 4][outputs][32]; row 0 of columns 1 to 3 is read
    float* t;          // [panels][inputs][32]: by d_input, written
    float* d_x;        // [panels * 4][inputs][32]: columns 1 to 3 are written; or null
    int inputs, outputs;
    int rows;
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> d_y = load_sdf_gradient<T>(a.d_y, i, a.outputs);
    for (int r = 0; r < a.rows; ++r) {
      const size_t at = panel_at(i, 1, 0, a.inputs, r);
      T t = T(0.0f);
      for (int c = 0; c < 3; ++c) t = t + d_y[c] * load<T>(a.x + panel_at(i, 4, 1 + c, a.inputs, r));
      store<T>(a.t + at, t);
      if (!a.d_x) continue;
      const T d = load<T>(a.d_input + at);
      for (int c = 0; c < 3; ++c) store<T>(a.d_x + panel_at(i, 4, 1 + c, a.inputs, r), d_y[c] * d);
    }
  }
};

}  // namespace cei3d
