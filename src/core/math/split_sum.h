// SPDX-License-Identifier: Apache-2.0
// The split-sum approximation [Karis 2013]: the fraction of uniform light that a GGX surface reflects towards
// a viewer at cosine nv is F0 * scale + bias, with scale and bias tabulated over (nv, roughness). Error of
// the interpolation: below .0015 for nv > .08; .03 for smooth surfaces at nv = .02.
#pragma once

#include "core/math/pair_table.h"

namespace cei3d {

template <class T>
struct SplitSum {
  T scale, bias;
};

// The table of (scale, bias). Made on first use (10 ms).
const float* split_sum_table();

// Scale and bias by quadrature over facets, for the table and its tests. nv in (0, 1].
SplitSum<double> split_sum_integral(double nv, double roughness);

template <class T>
struct SplitSumGrad {
  SplitSum<T> value, d_nv, d_roughness;
};
// table: split_sum_table(), or a copy of it on the device that this runs on; see table_pair_grad().
template <class T>
HD SplitSumGrad<T> split_sum_grad(const float* table, T nv, T roughness) {
  const TablePairGrad<T> g = table_pair_grad(table, nv, roughness);
  return {{g.value.first, g.value.second},
          {g.d_nv.first, g.d_nv.second},
          {g.d_roughness.first, g.d_roughness.second}};
}
template <class T>
HD SplitSum<T> split_sum(const float* table, T nv, T roughness) {
  return split_sum_grad(table, nv, roughness).value;
}

}  // namespace cei3d
