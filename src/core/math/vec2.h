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
// Area of the parallelogram that two vectors span, positive when b lies counter-clockwise of a.
template <class T>
HD T signed_area(Vec2<T> a, Vec2<T> b) {
  return a.x * b.y - a.y * b.x;
}
// Barycentrics b1 and b2 of p = b1 e + b2 g, a point of the triangle with edges e and g from the origin.
template <class T>
HD Vec2<T> barycentrics_in(Vec2<T> e, Vec2<T> g, Vec2<T> p) {
  const T area = signed_area(e, g);
  return {signed_area(p, g) / area, signed_area(e, p) / area};
}

}  // namespace cei3d
