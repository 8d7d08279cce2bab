// SPDX-License-Identifier: Apache-2.0
// The mirror direction of a viewer about a normal, and its adjoint.
#pragma once

#include "core/math/vec.h"

namespace cei3d {

// v mirrored about n; both unit. The result has unit length up to rounding.
template <class T>
HD Vec3<T> mirrored(Vec3<T> n, Vec3<T> v) {
  return n * (T(2.0f) * dot(n, v)) - v;
}
template <class T>
HD Vec3<T> mirrored_direction(Vec3<T> n, Vec3<T> v) {
  return normalize(mirrored(n, v));
}
// Adjoint of mirrored_direction(): adds to d_n and d_v, which are tangent to the unit sphere at n and v.
template <class T>
HD void mirrored_direction_grad(Vec3<T> n, Vec3<T> v, Vec3<T> d_mirror, Vec3<T>& d_n, Vec3<T>& d_v) {
  const T two(2.0f), along = dot(d_mirror, n);
  const Vec3<T> by_n = (v * along + d_mirror * dot(n, v)) * two, by_v = n * (two * along) - d_mirror;
  d_n += by_n - n * dot(by_n, n);
  d_v += by_v - v * dot(by_v, v);
}

}  // namespace cei3d
