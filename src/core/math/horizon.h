// SPDX-License-Identifier: Apache-2.0
// What a surface reflects lies above its horizon; its reflection lobe in closed form (core/math/reflection.h)
// reaches below. A light lobe times a reflection lobe is about a Gaussian: its axis lies between theirs, and
// its sharpness is the sum of theirs. A logistic function gives the share of it above the horizon. That share
// over the share of the reflection lobe itself multiplies the reflection of the light lobe, so that an even
// light is reflected as before.
#pragma once

#include "core/math/reflection.h"

namespace cei3d {

// The reflection lobe is taken for one Gaussian with this share of its mean sharpness in the plane of
// incidence: its tails count. Found by comparison with the exact density, under lights of sharpness .2 to
// 120, at roughness .25 to .85 and cosines of .25 to .8.
inline constexpr float kHorizonSharpness = 0.7f;
// The logistic function of 1.702 x is the normal distribution's within .01.
inline constexpr float kLogisticScale = 1.702f;

template <class T>
HD T logistic(T x) {
  return T(1.0f) / (T(1.0f) + exp(min(-x, T(80.0f))));
}

template <class T>
struct HorizonShareGrad {
  T value, d_lambda, d_cosine, d_sharpness, d_height;
};

// The horizon of a reflection lobe.
template <class T>
struct Horizon {
  T sharpness;  // of the reflection lobe
  T height;     // cosine of its axis and the normal, >= 0
  T below;      // share of the reflection lobe below the horizon, [0, .5]

  // cosine: of the light lobe's axis and the normal.
  HD HorizonShareGrad<T> share_grad(T lambda, T cosine) const {
    const T k(kLogisticScale), half(0.5f), one(1.0f), root = sqrt(lambda + sharpness), inverse = one / root,
                                                      x = (lambda * cosine + sharpness * height) * inverse,
                                                      above = logistic(k * x), whole = one - below,
                                                      value = above / whole;
    const T d_x = k * value * (one - above), d_sum = x * (half * inverse);  // the root's part
    const T d_whole = k * value * below, root_of_lobe = sqrt(sharpness);
    return {value, d_x * (cosine - d_sum) * inverse, d_x * lambda * inverse,
            d_x * (height - d_sum) * inverse - d_whole * height * half / root_of_lobe,
            d_x * sharpness * inverse - d_whole * root_of_lobe};
  }
  HD T share(T lambda, T cosine) const {
    const T x = (lambda * cosine + sharpness * height) / sqrt(lambda + sharpness);
    return logistic(T(kLogisticScale) * x) / (T(1.0f) - below);
  }
};

template <class T>
HD T horizon_sharpness(const StretchedLobe<T>& lobe) {
  T sum(0.0f);
  for (int j = 0; j < kReflectionLobes; ++j)
    sum += T(kHorizonSharpness * reflection_share(j)) * lobe.along[j];
  return sum;
}
// height: cosine of the lobe's axis and the normal.
template <class T>
HD Horizon<T> horizon_of(const StretchedLobe<T>& lobe, T height) {
  const T sharpness = horizon_sharpness(lobe), above = max(height, T(0.0f));
  return {sharpness, above, logistic(T(-kLogisticScale) * above * sqrt(sharpness))};
}
// Adjoint of horizon_of(): adds to d_lobe. Returns the derivative by the height.
template <class T>
HD T horizon_grad(T height, T d_sharpness, T d_height, StretchedLobe<T>& d_lobe) {
  for (int j = 0; j < kReflectionLobes; ++j)
    d_lobe.along[j] += T(kHorizonSharpness * reflection_share(j)) * d_sharpness;
  return select(height < T(0.0f), T(0.0f), d_height);
}

}  // namespace cei3d
