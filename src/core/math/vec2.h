// SPDX-License-Identifier: Apache-2.0
// Arithmetic of vectors in the plane.
#pragma once

#include "core/math/vec.h"

namespace cei3d {

using Vec2d = Vec2<double>;

template <class T>
HD Vec2<T> operator+(Vec2<T> a, Vec2<T> b) {
  return {a.x + b.x, a.y + b.y};
}
template <class T>
HD Vec2<T> operator-(Vec2<T> a, Vec2<T> b) {
  return {a.x - b.x, a.y - b.y};
}
template <class T>
HD Vec2<T> operator*(Vec2<T> a, T s) {
  return {a.x * s, a.y * s};
}
// Of the parallelogram that two vectors span, positive when b lies counter-clockwise of a.
template <class T>
HD T signed_area(Vec2<T> a, Vec2<T> b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace cei3d
