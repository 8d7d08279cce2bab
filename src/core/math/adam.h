// SPDX-License-Identifier: Apache-2.0
// Adam [Kingma and Ba 2015].
#pragma once

#include <cmath>
#include <cstdint>

#include "core/math/scalar.h"

namespace cei3d {

struct AdamStep {
  float rate;  // learning rate, times bias_correction()
  float beta1, beta2, eps;
  bool skip_zero;  // skip entries without gradient (hash tables: most are untouched in a step)
};

// Factor of the learning rate in step t = 1, 2, ..., because both means start at zero.
inline double bias_correction(double beta1, double beta2, int64_t t) {
  return std::sqrt(1 - std::pow(beta2, double(t))) / (1 - std::pow(beta1, double(t)));
}

// Updates one parameter.
template <class T>
HD void adam_update(const AdamStep& s, T gradient, T& value, T& m, T& v) {
  const T m1 = m * T(s.beta1) + gradient * T(1.0f - s.beta1);
  const T v1 = v * T(s.beta2) + gradient * gradient * T(1.0f - s.beta2);
  const T x1 = value - T(s.rate) * m1 / (sqrt(v1) + T(s.eps));
  const auto keep = (gradient == T(0.0f)) & (T(s.skip_zero ? 0.0f : 1.0f) == T(0.0f));
  m = select(keep, m, m1);
  v = select(keep, v, v1);
  value = select(keep, value, x1);
}

}  // namespace cei3d
