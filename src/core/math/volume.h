// SPDX-License-Identifier: Apache-2.0
// Opacity of a signed distance field along rays, differentiable, for gradient descent. The distance of a
// point is known up to a logistic error with inverse standard deviation `inv_s`: Phi(f) = sigmoid(inv_s f) is
// the logistic distribution function, and a section of a ray on which Phi falls from Phi(before) to
// Phi(after) absorbs the share max(0, 1 - Phi(after) / Phi(before)) of the light that reaches it. [Wang et
// al. 2021 (NeuS), eq. 13]
#pragma once

#include "core/math/activation.h"

namespace cei3d {

inline constexpr float kNeusEpsilon = 1e-5f;  // keeps the ratio finite where Phi vanishes

// 1 - phi_after / phi_before, not clamped. Where both vanish, deep inside, it becomes inside / kNeusEpsilon.
template <class T>
HD T neus_ratio(T phi_before, T phi_after, T inside) {
  return (phi_before - phi_after + inside) / (phi_before + T(kNeusEpsilon));
}

template <class T>
struct NeusSample {
  T alpha;
  T d_sdf, d_cosine;  // derivatives of alpha
};

// Opacity of a section of length `delta` whose middle has signed distance `sdf` and along which the distance
// changes by `cosine` (gradient . direction) per unit of length. Without the derivative by the cosine the
// zero set would shrink. Deep inside a section is opaque. NeuS softens the cosine early in training; when
// training starts from the visual hull that costs 1 dB, so this does not.
template <class T>
HD NeusSample<T> neus_alpha(T sdf, T cosine, T delta, T inv_s) {
  const T zero(0.0f), one(1.0f), half(0.5f), eps(kNeusEpsilon);
  const auto entering = cosine < zero;
  const T change = select(entering, cosine, zero), change_by_cosine = select(entering, one, zero);
  const auto before = Sigmoid::eval(inv_s * (sdf - half * change * delta), 1.0f);
  const auto after = Sigmoid::eval(inv_s * (sdf + half * change * delta), 1.0f);
  const T raw = neus_ratio(before.value, after.value, eps), q = before.value + eps;
  const auto inside = (raw > zero) & (raw < one);
  // raw = 1 - after / q
  const T d_before = after.value / (q * q) * before.first * inv_s;
  const T d_after = -(after.first * inv_s / q);
  const T d_sdf = d_before + d_after;
  const T d_cosine = half * delta * change_by_cosine * (d_after - d_before);
  return {clamp(raw, zero, one), select(inside, d_sdf, zero), select(inside, d_cosine, zero)};
}

// Signed distances at a point of a ray and at the points one step before and behind it, where there are any.
template <class T>
struct NeusNeighbors {
  T previous, value, next;
  bool has_previous, has_next;
};

// Opacity of the section of length `delta` around the point, for choosing samples before gradients are known:
// the distance changes as between neighbors, and as for a surface met at 45 degrees where there are none.
// Deep inside a section is transparent, so that nothing is sampled there.
template <class T>
HD T neus_alpha_of_neighbors(const NeusNeighbors<T>& n, T delta, T inv_s) {
  const T half(0.5f);
  const T half_change = select(n.has_next, half * (n.next - n.value),
                               select(n.has_previous, half * (n.value - n.previous), T(-0.35f) * delta));
  const T before = select(n.has_previous, half * (n.value + n.previous), n.value - half_change);
  const T after = n.value + half_change;
  const T phi_before = Sigmoid::eval(inv_s * before, 1.0f).value,
          phi_after = Sigmoid::eval(inv_s * after, 1.0f).value;
  return clamp(neus_ratio(phi_before, phi_after, T(0.0f)), T(0.0f), T(1.0f));
}

}  // namespace cei3d
