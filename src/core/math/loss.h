// SPDX-License-Identifier: Apache-2.0
// Losses: value and gradient.
#pragma once

#include "core/math/activation.h"
#include "core/math/vec.h"

namespace cei3d {

template <class T, class Gradient = T>
struct LossValue {
  T value;
  Gradient gradient;
};

// Quadratic below `width`, slope 1 beyond: e^2 / (2 width), |e| - width / 2. [Huber 1964]
template <class T>
HD LossValue<T> huber(T e, T width) {
  const T a = abs(e);
  const auto small = a < width;
  return {select(small, T(0.5f) * e * e / width, a - T(0.5f) * width),
          select(small, e / width, select(e > T(0.0f), T(1.0f), T(-1.0f)))};
}

// The sum over the channels of a color error.
template <class T>
HD LossValue<T, Vec3<T>> huber(Vec3<T> e, T width) {
  const LossValue<T> x = huber(e.x, width), y = huber(e.y, width), z = huber(e.z, width);
  return {x.value + y.value + z.value, {x.gradient, y.gradient, z.gradient}};
}

// (|g| - 1)^2: the gradient of a distance has unit length. [Gropp et al. 2020; paper eq. 16]
template <class T>
HD LossValue<T, Vec3<T>> eikonal(Vec3<T> g) {
  const T n = sqrt(dot(g, g) + T(1e-12f));
  return {(n - T(1.0f)) * (n - T(1.0f)), g * (T(2.0f) * (n - T(1.0f)) / n)};
}

// softplus(-sdf): pushes a point outside that lies on a ray through background. The color loss cannot open a
// gap that has closed, because the opacity of an opaque ray has no slope; this penalty has one. inv_s: of the
// opacity; the penalty turns over within a distance of 1 / inv_s.
template <class T>
HD LossValue<T> empty_push(T sdf, float inv_s) {
  const ActivationValue<T> inside = Softplus::eval(-sdf, inv_s);
  return {inside.value, -inside.first};
}
// softplus(sdf): the opposite, for the point of a ray through the object that comes nearest to the surface
// but misses it. The two are the cross entropy of a mask with the coverage sigmoid(-inv_s sdf), over inv_s.
// [Yariv et al. 2020]
template <class T>
HD LossValue<T> cover_pull(T sdf, float inv_s) {
  const ActivationValue<T> outside = Softplus::eval(sdf, inv_s);
  return {outside.value, outside.first};
}

}  // namespace cei3d
