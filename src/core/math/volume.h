// SPDX-License-Identifier: Apache-2.0
// Volume rendering of a signed distance field, so that a surface can be found by descent. [Wang et al. 2021,
// eq. 13; paper sec. 3]
#pragma once

#include "core/math/activation.h"

namespace cei3d {

template <class T>
struct NeusSample {
  T alpha;
  T d_sdf, d_cosine;  // of alpha
};

// Opacity of a segment of length `delta` whose middle has signed distance `sdf` and along which the distance
// changes by `cosine` (gradient . direction) a unit; without that slope the zero set would shrink.
// `sharpness` is s of the logistic density. NeuS softens the slope early in training; starting from the
// visual hull that costs 1 dB, so we don't.
template <class T>
HD NeusSample<T> neus_alpha(T sdf, T cosine, T delta, T sharpness) {
  const T zero(0.0f), one(1.0f), half(0.5f), eps(1e-5f);
  const auto entering = cosine < zero;
  const T slope = select(entering, cosine, zero), d_slope = select(entering, one, zero);
  const auto before = Sigmoid::eval(sharpness * (sdf - half * slope * delta), 1.0f);
  const auto after = Sigmoid::eval(sharpness * (sdf + half * slope * delta), 1.0f);
  const T q = before.value + eps;
  const T raw = (before.value - after.value + eps) / q;
  const auto inside = (raw > zero) & (raw < one);
  // raw = 1 - after / q
  const T by_before = after.value / (q * q) * before.first * sharpness;
  const T by_after = -(after.first * sharpness / q);
  const T d_sdf = by_before + by_after;
  const T d_cosine = half * delta * d_slope * (by_after - by_before);
  return {clamp(raw, zero, one), select(inside, d_sdf, zero), select(inside, d_cosine, zero)};
}

}  // namespace cei3d
