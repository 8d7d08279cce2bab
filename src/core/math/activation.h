// SPDX-License-Identifier: Apache-2.0
// Activations: value, first and second derivative.
#pragma once

#include "core/math/scalar.h"

namespace cei3d {

template <class T>
struct ActivationValue {
  T value, first, second;
};

struct Relu {
  template <class T>
  HD static ActivationValue<T> eval(T z, float) {
    const auto on = z > T(0.0f);
    return {select(on, z, T(0.0f)), select(on, T(1.0f), T(0.0f)), T(0.0f)};
  }
};

struct Elu {  // alpha = 1
  template <class T>
  HD static ActivationValue<T> eval(T z, float) {
    const auto on = z > T(0.0f);
    const T e = exp(min(z, T(0.0f)));
    return {select(on, z, e - T(1.0f)), select(on, T(1.0f), e), select(on, T(0.0f), e)};
  }
};

struct Softplus {  // log(1 + e^(beta z)) / beta, in the form that neither overflows nor cancels
  template <class T>
  HD static ActivationValue<T> eval(T z, float beta) {
    const T b = T(beta), x = b * z;
    const T e = exp(-abs(x));  // in (0, 1]
    const T inverse = reciprocal(T(1.0f) + e);
    const T sigma = select(x > T(0.0f), inverse, e * inverse);
    return {max(z, T(0.0f)) + log1p(e) * (T(1.0f) / b), sigma, b * sigma * (T(1.0f) - sigma)};
  }
};

struct Sigmoid {
  template <class T>
  HD static ActivationValue<T> eval(T z, float) {
    const T e = exp(-abs(z)), inverse = reciprocal(T(1.0f) + e);
    const T s = select(z > T(0.0f), inverse, e * inverse);
    const T d = s * (T(1.0f) - s);
    return {s, d, d * (T(1.0f) - T(2.0f) * s)};
  }
};

}  // namespace cei3d
