// SPDX-License-Identifier: Apache-2.0
// Bilinear interpolation in a square, and its derivatives.
#pragma once

#include "core/math/scalar.h"

namespace cei3d {

// Values at the corners of a square: a at (0, 0), b at (1, 0), c at (0, 1), d at (1, 1).
template <class T>
struct SquareCorners {
  T a, b, c, d;
};

template <class T, class V = T>
HD V bilinear(const SquareCorners<V>& v, T x, T y) {
  return (T(1) - y) * ((T(1) - x) * v.a + x * v.b) + y * ((T(1) - x) * v.c + x * v.d);
}
// The derivatives of bilinear() by x and y.
template <class T>
HD T bilinear_d_x(const SquareCorners<T>& v, T y) {
  return (T(1) - y) * (v.b - v.a) + y * (v.d - v.c);
}
template <class T>
HD T bilinear_d_y(const SquareCorners<T>& v, T x) {
  return (T(1) - x) * (v.c - v.a) + x * (v.d - v.b);
}

}  // namespace cei3d
