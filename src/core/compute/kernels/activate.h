// SPDX-License-Identifier: Apache-2.0
// Activations over `rows` rows of panels.
#pragma once

#include "core/compute/kernel.h"
#include "core/compute/kernels/panel.h"
#include "core/math/activation.h"

namespace cei3d {

struct ActivateArgs {
  const float* z;  // before the activation
  float* y;        // Activate: written. ActivateGrad: dL/dy on entry, dL/dz on return
  int z_stride, y_stride;
  int rows;
  float beta;
};

template <class A>
struct Activate {
  using Args = ActivateArgs;
  template <class T>
  static HD void run(const Args& a, int i) {
    const float beta = a.beta;  // a copy: the compiler must assume that stores change a.beta
    for (int r = 0; r < a.rows; ++r)
      store<T>(a.y + panel_at(i, 1, 0, a.y_stride, r),
               A::eval(load<T>(a.z + panel_at(i, 1, 0, a.z_stride, r)), beta).value);
  }
};

template <class A>
struct ActivateGrad {
  using Args = ActivateArgs;
  template <class T>
  static HD void run(const Args& a, int i) {
    const float beta = a.beta;  // a copy: the compiler must assume that stores change a.beta
    for (int r = 0; r < a.rows; ++r) {
      float* d = a.y + panel_at(i, 1, 0, a.y_stride, r);
      store<T>(d, load<T>(d) * A::eval(load<T>(a.z + panel_at(i, 1, 0, a.z_stride, r)), beta).first);
    }
  }
};

// Activations whose derivatives are needed later.
struct ActivateTwiceArgs {
  float* z_first;  // before the activation on entry, its first derivative there on return
  float* second;   // its second derivative, written
  float* y;
  int y_stride;  // the others have `rows` rows per panel
  int rows;
  float beta;
};

template <class A>
struct ActivateTwice {
  using Args = ActivateTwiceArgs;
  template <class T>
  static HD void run(const Args& a, int i) {
    const float beta = a.beta;
    for (int r = 0; r < a.rows; ++r) {
      const size_t at = panel_at(i, 1, 0, a.rows, r);
      const auto s = A::eval(load<T>(a.z_first + at), beta);
      store<T>(a.y + panel_at(i, 1, 0, a.y_stride, r), s.value);
      store<T>(a.z_first + at, s.first);
      store<T>(a.second + at, s.second);
    }
  }
};

}  // namespace cei3d
