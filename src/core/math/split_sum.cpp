// SPDX-License-Identifier: Apache-2.0
#include "core/math/split_sum.h"

#include "core/math/facets.h"

namespace cei3d {

SplitSum<double> split_sum_integral(double nv, double roughness) {
  SplitSum<double> sum{0, 0};
  for_reflections(nv, roughness, [&](double weight, const Vec3d&, double vh) {
    const double f = fresnel(0.0, vh);
    sum.scale += weight * (1 - f);
    sum.bias += weight * f;
  });
  return sum;
}

const float* split_sum_table() {
  static const PairTable table = make_pair_table([](double nv, double roughness) {
    const SplitSum<double> s = split_sum_integral(nv, roughness);
    return TablePair<double>{s.scale, s.bias};
  });
  return table.data();
}

}  // namespace cei3d
