// SPDX-License-Identifier: Apache-2.0
// Losses: value and gradient.
#pragma once

#include "core/math/vec.h"

namespace cei3d {

template <class T>
struct LossValue {
  T value, gradient;
};

// Quadratic below `width`, slope 1 beyond: e^2 / (2 width), |e| - width / 2. [Huber 1964]
template <class T>
HD LossValue<T> huber(T e, T width) {
  const T a = abs(e);
  const auto small = a < width;
  return {select(small, T(0.5f) * e * e / width, a - T(0.5f) * width),
          select(small, e / width, select(e > T(0.0f), T(1.0f), T(-1.0f)))};
}

// (|g| - 1)^2 and its gradient by g. [Gropp et al. 2020; paper eq. 16]
template <class T>
HD T eikonal(Vec3<T> g, Vec3<T>& d_g) {
  const T n = sqrt(dot(g, g) + T(1e-12f));
  d_g = g * (T(2.0f) * (n - T(1.0f)) / n);
  return (n - T(1.0f)) * (n - T(1.0f));
}

}  // namespace cei3d
