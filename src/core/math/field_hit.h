// SPDX-License-Identifier: Apache-2.0
// The point where a ray o + t d meets the zero set of a field f(x; Phi), as a function of the parameters Phi,
// and the adjoint, by which a loss of depth, position or normal reaches Phi. At every Phi
//
//   f(o + t(Phi) d; Phi) = 0                            [paper eq. 6]
//   dt/dPhi = -df/dPhi / <grad f, d>                    [paper eq. 7, 8]
//
// so that with a hit at depth t0 and point x0 that was traced with the present parameters Phi0, to first
// order
//
//   t(Phi) = t0 - f(x0; Phi) / <grad f(x0; Phi0), d>    [paper eq. 9]
//   x(Phi) = o + t(Phi) d                               [paper eq. 10]
//   n(Phi) = grad f(x(Phi); Phi) / |grad f|             [paper eq. 11]
//
// Where the ray grazes the surface, dt/dPhi grows beyond all bounds, and the hit is about to disappear, which
// no derivative describes. There <grad f, d> is replaced by -kGrazingCosine |grad f|: the derivative keeps
// its sign and is bounded. Silhouettes are left to the mask loss.
#pragma once

#include "core/math/vec.h"

namespace cei3d {

inline constexpr float kGrazingCosine = 0.1f;  // 84 degrees between ray and normal

// A traced hit and the field there.
template <class T>
struct TracedHit {
  T depth;
  Vec3<T> position, direction;  // direction: unit, of the ray
  T value;                      // of the field: zero up to the tolerance of the tracing
  Vec3<T> gradient;             // of the field
  Vec3<T> gradient_along;       // derivative of the gradient along the ray: Hessian times direction
};

template <class T>
struct FieldHit {
  T depth;
  Vec3<T> position, normal;
};

// <grad f, d>, the derivative of the field along a ray that enters the surface, bounded away from zero.
template <class T>
HD T entering_derivative(Vec3<T> gradient, Vec3<T> direction) {
  return min(dot(gradient, direction), T(-kGrazingCosine) * length(gradient));
}

// value and gradient: at the parameters Phi, at the point that was traced with Phi0.
template <class T>
HD FieldHit<T> field_hit(const TracedHit<T>& h) {
  const T shift = -h.value / entering_derivative(h.gradient, h.direction);
  return {h.depth + shift, h.position + h.direction * shift,
          normalize(h.gradient + h.gradient_along * shift)};
}

// dL/d(value and gradient of the field at the traced point) from dL/d(depth, position, normal), for a value
// of zero.
template <class T>
struct TracedHitGrad {
  T d_value;
  Vec3<T> d_gradient;
};
template <class T>
HD TracedHitGrad<T> field_hit_grad(const TracedHit<T>& h, const FieldHit<T>& d) {
  const T inverse = T(1.0f) / sqrt(dot(h.gradient, h.gradient) + T(1e-20f));
  const Vec3<T> n = h.gradient * inverse;
  const Vec3<T> d_gradient = (d.normal - n * dot(n, d.normal)) * inverse;
  const T d_depth = d.depth + dot(d.position, h.direction) + dot(d_gradient, h.gradient_along);
  return {-d_depth / entering_derivative(h.gradient, h.direction), d_gradient};
}

}  // namespace cei3d
