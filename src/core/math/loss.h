// SPDX-License-Identifier: Apache-2.0
// Losses: value and gradient.
#pragma once

#include "core/math/activation.h"
#include "core/math/color.h"
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

// The weight of a squared error e^2 / 2 in a least squares problem whose solution is that of the Huber loss
// times its width: gradient / e. [Huber 1964]
template <class T>
HD T huber_weight(T e, T width) {
  return min(width / max(abs(e), T(1e-9f)), T(1.0f));
}

// |e|; at 0, where it has no derivative, the gradient is 0.
template <class T>
HD LossValue<T> absolute(T e) {
  return {abs(e), select(e > T(0.0f), T(1.0f), select(e < T(0.0f), T(-1.0f), T(0.0f)))};
}

// Losses of one channel of a color of the surface, with the derivative by the radiance; radiance and photo
// are linear. clipped: `photo` is only a lower bound of the true radiance, so that more is no error.
template <class T>
HD LossValue<T> unless_clipped(T radiance, T photo, bool clipped, LossValue<T> loss) {
  const bool satisfied = clipped && radiance >= photo;
  return {select(satisfied, T(0.0f), loss.value), select(satisfied, T(0.0f), loss.gradient)};
}
// The Huber loss of display-encoded colors. The slope of the display curve, which rises towards black and
// would let dark pixels outweigh all others, is that of kDarkest below it.
template <class T>
HD LossValue<T> display_loss(T radiance, T photo, bool clipped = false) {
  constexpr float kWidth = 0.05f, kDarkest = 0.004f;
  const LossValue<T> loss =
      huber(srgb_from_linear(max(T(0.0f), radiance)) - srgb_from_linear(photo), T(kWidth));
  const T slope = srgb_derivative(max(T(kDarkest), radiance));
  return unless_clipped(radiance, photo, clipped, {loss.value, loss.gradient * slope});
}
// The absolute error of linear radiance. [paper eq. 16]
template <class T>
HD LossValue<T> linear_loss(T radiance, T photo, bool clipped = false) {
  return unless_clipped(radiance, photo, clipped, absolute(radiance - photo));
}

// Cross entropy of a color y in [0, 1] with the one that is wanted: behind a sigmoid its gradient becomes
// y - wanted, so that dark and saturated colors, where the sigmoid is flat, are learned as fast as others.
// Within kEdge of 0 and of 1 the slope is bounded.
template <class T>
HD LossValue<T> cross_entropy(T y, T wanted) {
  constexpr float kEdge = 1e-6f;
  const T one(1.0f), inner = clamp(y, T(kEdge), T(1.0f - kEdge));
  return {-(wanted * log(inner) + (one - wanted) * log(one - inner)),
          (y - wanted) / max(y * (one - y), T(kEdge))};
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
