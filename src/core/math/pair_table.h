// SPDX-License-Identifier: Apache-2.0
// Pairs of numbers tabulated over the cosine nv of normal and viewer and over roughness. Between the nodes
// they are a product of Catmull-Rom splines, so that they have continuous slopes.
#pragma once

#include <array>

#include "core/math/roughness.h"

namespace cei3d {

// Nodes of a table: nv from 0 to 1 and roughness from kMinRoughness to 1 at equal distances. One more node on
// each side, extrapolated linearly, spares the lookup all special cases.
inline constexpr int kTableCosines = 32, kTableRoughnesses = 24;
inline constexpr int kTableColumns = kTableCosines + 2, kTableRows = kTableRoughnesses + 2;

template <class T>
struct TablePair {
  T first, second;
};
using PairTable = std::array<float, size_t(2) * kTableRows * kTableColumns>;  // [row][column][first, second]

// value: int node of roughness, int node of nv -> TablePair<double>.
template <class F>
PairTable make_pair_table_of_nodes(const F& value) {
  PairTable t;
  const auto node = [&](int row, int column) { return &t[2 * (size_t(row) * kTableColumns + column)]; };
  const auto extrapolate = [](float* out, const float* border, const float* inner) {
    for (int k = 0; k < 2; ++k) out[k] = 2 * border[k] - inner[k];
  };
  for (int r = 0; r < kTableRoughnesses; ++r) {
    for (int c = 0; c < kTableCosines; ++c) {
      const TablePair<double> p = value(r, c);
      node(r + 1, c + 1)[0] = float(p.first);
      node(r + 1, c + 1)[1] = float(p.second);
    }
    extrapolate(node(r + 1, 0), node(r + 1, 1), node(r + 1, 2));
    extrapolate(node(r + 1, kTableColumns - 1), node(r + 1, kTableColumns - 2),
                node(r + 1, kTableColumns - 3));
  }
  for (int c = 0; c < kTableColumns; ++c) {
    extrapolate(node(0, c), node(1, c), node(2, c));
    extrapolate(node(kTableRows - 1, c), node(kTableRows - 2, c), node(kTableRows - 3, c));
  }
  return t;
}

// value: double nv, double roughness -> TablePair<double>. It is never asked for an nv below 1e-3.
template <class F>
PairTable make_pair_table(const F& value) {
  constexpr double kMinCosine = 1e-3;
  return make_pair_table_of_nodes([&](int r, int c) {
    return value(max(double(c) / (kTableCosines - 1), kMinCosine),
                 roughness_of_share(double(r) / (kTableRoughnesses - 1)));
  });
}

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
struct TablePairGrad {
  TablePair<T> value, d_nv, d_roughness;
};

// table: PairTable::data(), or a copy of it on the device that this runs on. Arguments outside the table's
// range are clamped to it, and the derivative by a clamped argument is 0.
template <class T>
HD TablePairGrad<T> table_pair_grad(const float* table, T nv, T roughness) {
  using I = Index<T>;
  const float columns = kTableCosines - 1, rows = (kTableRoughnesses - 1) / kRoughnessRange;
  const T zero(0.0f), one(1.0f);
  const T x = clamp(nv, zero, one) * T(columns),
          y = (clamp(roughness, T(kMinRoughness), one) - T(kMinRoughness)) * T(rows);
  const T i = min(floor(x), T(columns - 1)), j = min(floor(y), T(float(kTableRoughnesses - 2)));
  const SplineWeights<T> u = catmull_rom(x - i), v = catmull_rom(y - j);
  const I corner = to_index<T>(j) * I(uint32_t(kTableColumns)) + to_index<T>(i);
  TablePairGrad<T> g{{zero, zero}, {zero, zero}, {zero, zero}};
  for (int row = 0; row < 4; ++row) {
    TablePair<T> sum{zero, zero}, d_sum{zero, zero};
    for (int column = 0; column < 4; ++column) {
      T first, second;
      gather2(table, corner + I(uint32_t(row * kTableColumns + column)), first, second);
      sum.first += u.weight[column] * first;
      sum.second += u.weight[column] * second;
      d_sum.first += u.d_weight[column] * first;
      d_sum.second += u.d_weight[column] * second;
    }
    g.value.first += v.weight[row] * sum.first;
    g.value.second += v.weight[row] * sum.second;
    g.d_nv.first += v.weight[row] * d_sum.first;
    g.d_nv.second += v.weight[row] * d_sum.second;
    g.d_roughness.first += v.d_weight[row] * sum.first;
    g.d_roughness.second += v.d_weight[row] * sum.second;
  }
  const T by_nv = select((nv < zero) | (nv > one), zero, T(columns)),
          by_roughness = select((roughness < T(kMinRoughness)) | (roughness > one), zero, T(rows));
  g.d_nv = {g.d_nv.first * by_nv, g.d_nv.second * by_nv};
  g.d_roughness = {g.d_roughness.first * by_roughness, g.d_roughness.second * by_roughness};
  return g;
}

}  // namespace cei3d
