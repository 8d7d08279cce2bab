// SPDX-License-Identifier: Apache-2.0
// The kernel of a step of Adam.
#pragma once

#include "core/compute/kernel.h"
#include "core/math/adam.h"

namespace cei3d {

// Updates n parameters in place and clears their gradient.
struct Adam {
  struct Args {
    AdamStep step;
    float *value, *gradient, *m, *v;  // [n]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const T g = load<T>(a.gradient + i);
    if (a.step.skip_zero && all(g == T(0.0f))) return;
    T x = load<T>(a.value + i), m = load<T>(a.m + i), v = load<T>(a.v + i);
    adam_update(a.step, g, x, m, v);
    store<T>(a.value + i, x);
    store<T>(a.m + i, m);
    store<T>(a.v + i, v);
    store<T>(a.gradient + i, T(0.0f));
  }
};

}  // namespace cei3d
