// SPDX-License-Identifier: Apache-2.0
// Activations over `rows` rows of panels, on values (columns 1) or jets (columns 4).
#pragma once

#include "core/compute/kernels/panel.h"
#include "core/math/activation.h"

namespace cei3d {

struct ActivateArgs {
  const float* z;  // before the activation
  float* y;        // Activate: written. ActivateGrad: dL/dy on entry, dL/dz on return
  int z_stride, y_stride;
  int rows, columns;
  float beta;
};

template <class A>
struct Activate {
  using Args = ActivateArgs;
  template <class T>
  static HD void run(const Args& a, int i) {
    const float beta = a.beta;  // a copy: the compiler must assume that stores change a.beta
    for (int r = 0; r < a.rows; ++r) {
      const auto s = A::eval(load<T>(a.z + panel_at(i, a.columns, 0, a.z_stride, r)), beta);
      store<T>(a.y + panel_at(i, a.columns, 0, a.y_stride, r), s.value);
      for (int c = 1; c < a.columns; ++c)
        store<T>(a.y + panel_at(i, a.columns, c, a.y_stride, r),
                 s.first * load<T>(a.z + panel_at(i, a.columns, c, a.z_stride, r)));
    }
  }
};

template <class A>
struct ActivateGrad {
  using Args = ActivateArgs;
  template <class T>
  static HD void run(const Args& a, int i) {
    const float beta = a.beta;  // a copy: the compiler must assume that stores change a.beta
    for (int r = 0; r < a.rows; ++r) {
      const auto s = A::eval(load<T>(a.z + panel_at(i, a.columns, 0, a.z_stride, r)), beta);
      float* value = a.y + panel_at(i, a.columns, 0, a.y_stride, r);
      T d = load<T>(value) * s.first;
      for (int c = 1; c < a.columns; ++c) {
        float* column = a.y + panel_at(i, a.columns, c, a.y_stride, r);
        const T d_column = load<T>(column);
        d = d + d_column * s.second * load<T>(a.z + panel_at(i, a.columns, c, a.z_stride, r));
        store<T>(column, d_column * s.first);
      }
      store<T>(value, d);
    }
  }
};

}  // namespace cei3d
