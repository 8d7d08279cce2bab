// SPDX-License-Identifier: Apache-2.0
// The split-sum approximation [Karis 2013]: what a GGX surface reflects of uniform light towards a viewer at
// cosine nv is F0 * scale + bias, with scale and bias tabulated over (nv, roughness). Between the nodes of
// the table the surface is a product of Catmull-Rom splines, so that it has continuous slopes. Error of the
// interpolation: below .0015 for nv > .08; .03 for smooth surfaces at nv = .02.
#pragma once

#include "core/math/brdf.h"

namespace cei3d {

// Nodes of the table: nv from 0 to 1 and roughness from kMinRoughness to 1 at equal distances. One more node
// on each side, extrapolated linearly, spares the lookup all special cases.
inline constexpr int kSplitSumCosines = 32, kSplitSumRoughnesses = 24;
inline constexpr int kSplitSumColumns = kSplitSumCosines + 2, kSplitSumRows = kSplitSumRoughnesses + 2;

template <class T>
struct SplitSum {
  T scale, bias;
};

// The table: [kSplitSumRows][kSplitSumColumns][scale, bias], with the extrapolated nodes. Made on first use
// (10 ms).
const float* split_sum_table();

// Scale and bias by quadrature over facets, for the table and its tests. nv in (0, 1].
SplitSum<double> split_sum_integral(double nv, double roughness);

template <class T>
struct SplineWeights {
  T weight[4], d_weight[4];  // of four equally spaced nodes; derivatives by the position
};
// Catmull-Rom spline at position t in [0, 1] between the two middle nodes.
template <class T>
HD SplineWeights<T> catmull_rom(T t) {
  const T half(0.5f), t2 = t * t;
  return {{t * (t - half * t2 - half), T(1.0f) + t2 * (T(1.5f) * t - T(2.5f)),
           t * (half + T(2.0f) * t - T(1.5f) * t2), half * t2 * (t - T(1.0f))},
          {T(2.0f) * t - half - T(1.5f) * t2, t * (T(4.5f) * t - T(5.0f)), half + T(4.0f) * t - T(4.5f) * t2,
           t * (T(1.5f) * t - T(1.0f))}};
}

template <class T>
struct SplitSumGrad {
  SplitSum<T> value, d_nv, d_roughness;
};

// table: split_sum_table(), or a copy of it on the device that this runs on. Arguments outside the table's
// range are clamped to it, and the derivative by a clamped argument is 0.
template <class T>
HD SplitSumGrad<T> split_sum_grad(const float* table, T nv, T roughness) {
  using I = Index<T>;
  const float columns = kSplitSumCosines - 1, rows = (kSplitSumRoughnesses - 1) / (1 - kMinRoughness);
  const T zero(0.0f), one(1.0f);
  const T x = clamp(nv, zero, one) * T(columns),
          y = (clamp(roughness, T(kMinRoughness), one) - T(kMinRoughness)) * T(rows);
  const T i = min(floor(x), T(columns - 1)), j = min(floor(y), T(float(kSplitSumRoughnesses - 2)));
  const SplineWeights<T> u = catmull_rom(x - i), v = catmull_rom(y - j);
  const I first = to_index<T>(j) * I(uint32_t(kSplitSumColumns)) + to_index<T>(i);
  SplitSumGrad<T> g{{zero, zero}, {zero, zero}, {zero, zero}};
  for (int row = 0; row < 4; ++row) {
    SplitSum<T> sum{zero, zero}, d_sum{zero, zero};
    for (int column = 0; column < 4; ++column) {
      T scale, bias;
      gather2(table, first + I(uint32_t(row * kSplitSumColumns + column)), scale, bias);
      sum.scale += u.weight[column] * scale;
      sum.bias += u.weight[column] * bias;
      d_sum.scale += u.d_weight[column] * scale;
      d_sum.bias += u.d_weight[column] * bias;
    }
    g.value.scale += v.weight[row] * sum.scale;
    g.value.bias += v.weight[row] * sum.bias;
    g.d_nv.scale += v.weight[row] * d_sum.scale;
    g.d_nv.bias += v.weight[row] * d_sum.bias;
    g.d_roughness.scale += v.d_weight[row] * sum.scale;
    g.d_roughness.bias += v.d_weight[row] * sum.bias;
  }
  const T by_nv = select((nv < zero) | (nv > one), zero, T(columns)),
          by_roughness = select((roughness < T(kMinRoughness)) | (roughness > one), zero, T(rows));
  g.d_nv = {g.d_nv.scale * by_nv, g.d_nv.bias * by_nv};
  g.d_roughness = {g.d_roughness.scale * by_roughness, g.d_roughness.bias * by_roughness};
  return g;
}
template <class T>
HD SplitSum<T> split_sum(const float* table, T nv, T roughness) {
  return split_sum_grad(table, nv, roughness).value;
}

}  // namespace cei3d
