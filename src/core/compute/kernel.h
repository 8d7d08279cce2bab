// SPDX-License-Identifier: Apache-2.0
// A kernel is a struct with plain `Args` (pointers and sizes) and `template <class T> static HD void
// run(const Args&, int i)`. Item i is one CUDA thread, or on the CPU the first of W samples in the lanes of
// one register. Forward and gradient stand in the same file; kernels/all.h is the only registry.
#pragma once

#include "core/math/scalar.h"

namespace cei3d {

template <class... K>
struct KernelList {
  template <class X>
  static constexpr int index_of() {
    constexpr bool same[] = {__is_same(X, K)...};
    for (int i = 0; i < int(sizeof...(K)); ++i)
      if (same[i]) return i;
    return -1;
  }
};

}  // namespace cei3d
