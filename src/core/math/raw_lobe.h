// SPDX-License-Identifier: Apache-2.0
// Spherical Gaussians by numbers without bounds, for descent: an axis of any length, the logarithm of
// lambda, the square root of the color.
#pragma once

#include "core/math/vec.h"

namespace cei3d {

// Numbers of a lobe, its raw numbers, or derivatives by either.
template <class T>
struct LobeNumbers {
  Vec3<T> axis;
  T lambda;  // sharpness
  Vec3<T> color;
};

template <class T>
HD LobeNumbers<T> lobe_of_raw(const LobeNumbers<T>& raw) {
  return {normalize(raw.axis), exp(raw.lambda), raw.color * raw.color};
}
// dL/d(raw numbers) from dL/d(lobe).
template <class T>
HD LobeNumbers<T> lobe_of_raw_grad(const LobeNumbers<T>& raw, const LobeNumbers<T>& d_lobe) {
  const Vec3<T> axis = normalize(raw.axis);
  return {(d_lobe.axis - axis * dot(d_lobe.axis, axis)) / length(raw.axis), exp(raw.lambda) * d_lobe.lambda,
          T(2.0f) * raw.color * d_lobe.color};
}

}  // namespace cei3d
