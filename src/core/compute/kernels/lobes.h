// SPDX-License-Identifier: Apache-2.0
// Arguments of kernels that read light lobes. No kernel is here, so that headers of other modules can hold
// lobes without being rebuilt for a new kernel.
#pragma once

#include "core/math/vec.h"

namespace cei3d {

// Light lobes as planes [7][padded]: axis (unit), lambda (sharpness), mu (peak color).
struct LobePlanes {
  const float* data;
  int count, padded;  // padded: a multiple of 32; unused lobes have zero color
  template <class T>
  HD Vec3<T> axis(int k) const {
    return {T(data[k]), T(data[padded + k]), T(data[2 * padded + k])};
  }
  template <class T>
  HD T lambda(int k) const {
    return T(data[3 * padded + k]);
  }
  template <class T>
  HD Vec3<T> mu(int k) const {
    return {T(data[4 * padded + k]), T(data[5 * padded + k]), T(data[6 * padded + k])};
  }
};

template <class T>
HD Vec3<T> load_planes(const float* p, int stride, int i) {  // [3][stride]
  return {load<T>(p + i), load<T>(p + stride + i), load<T>(p + 2 * stride + i)};
}
template <class T>
HD void store_planes(float* p, int stride, int i, Vec3<T> v) {
  store<T>(p + i, v.x);
  store<T>(p + stride + i, v.y);
  store<T>(p + 2 * stride + i, v.z);
}

}  // namespace cei3d
