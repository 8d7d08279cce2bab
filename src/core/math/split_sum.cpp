// SPDX-License-Identifier: Apache-2.0
#include "core/math/split_sum.h"

#include <array>

namespace cei3d {
namespace {

using Table = std::array<float, size_t(2) * kSplitSumRows * kSplitSumColumns>;

float* node(Table& t, int row, int column) {
  return &t[2 * (size_t(row) * kSplitSumColumns + size_t(column))];
}

void extrapolate(float* out, const float* border, const float* inner) {
  for (int k = 0; k < 2; ++k) out[k] = 2 * border[k] - inner[k];
}

Table make_table() {
  constexpr double kMinCosine = 1e-3;  // the quadrature divides by it
  Table t;
  for (int r = 0; r < kSplitSumRoughnesses; ++r) {
    const double roughness = kMinRoughness + (1 - kMinRoughness) * double(r) / (kSplitSumRoughnesses - 1);
    for (int c = 0; c < kSplitSumCosines; ++c) {
      const SplitSum<double> s =
          split_sum_integral(max(double(c) / (kSplitSumCosines - 1), kMinCosine), roughness);
      float* p = node(t, r + 1, c + 1);
      p[0] = float(s.scale), p[1] = float(s.bias);
    }
    extrapolate(node(t, r + 1, 0), node(t, r + 1, 1), node(t, r + 1, 2));
    extrapolate(node(t, r + 1, kSplitSumColumns - 1), node(t, r + 1, kSplitSumColumns - 2),
                node(t, r + 1, kSplitSumColumns - 3));
  }
  for (int c = 0; c < kSplitSumColumns; ++c) {
    extrapolate(node(t, 0, c), node(t, 1, c), node(t, 2, c));
    extrapolate(node(t, kSplitSumRows - 1, c), node(t, kSplitSumRows - 2, c), node(t, kSplitSumRows - 3, c));
  }
  return t;
}

}  // namespace

// Facets are drawn with the density of GGX: at u their cosine is sqrt((1 - u) / (1 + (alpha^2 - 1) u)). The
// integrand is steep near u = 1, so the nodes are dense there: u = 1 - (1 - t)^3. Error below 1e-3
// everywhere, 5e-4 nearly so.
SplitSum<double> split_sum_integral(double nv, double roughness) {
  constexpr int kRings = 40, kSteps = 16;  // steps: on half a turn, which the other half mirrors
  const double alpha = roughness * roughness;
  const Vec3d v{std::sqrt(1 - nv * nv), 0, nv};
  SplitSum<double> sum{0, 0};
  for (int i = 0; i < kRings; ++i) {
    const double rest = 1 - (i + 0.5) / kRings, u = 1 - rest * rest * rest, weight = 3 * rest * rest;
    const double c = std::sqrt((1 - u) / (1 + (alpha * alpha - 1) * u)), s = std::sqrt(1 - c * c);
    for (int j = 0; j < kSteps; ++j) {
      const double a = M_PI * (j + 0.5) / kSteps;
      const Vec3d h{s * std::cos(a), s * std::sin(a), c};
      const double vh = dot(v, h), nl = 2 * vh * h.z - v.z;
      if (vh <= 0 || nl <= 0) continue;
      const double g = weight * smith_g1(nv, alpha) * smith_g1(nl, alpha) * vh / (c * nv),
                   f = schlick(0.0, vh);
      sum.scale += g * (1 - f);
      sum.bias += g * f;
    }
  }
  return {sum.scale / (kRings * kSteps), sum.bias / (kRings * kSteps)};
}

const float* split_sum_table() {
  static const Table table = make_table();
  return table.data();
}

}  // namespace cei3d
