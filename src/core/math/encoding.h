// SPDX-License-Identifier: Apache-2.0
// Encodings of a point in [-1, 1]^3: one level of a multi-resolution hash grid (trilinear) and the frequency
// encoding. [Mueller et al. 2022, sec. 3]
#pragma once

#include "core/math/vec.h"

namespace cei3d {

// One level of the grid: `resolution` cells along [-1, 1]. Levels whose (resolution + 1)^3 corners fit the
// table are indexed densely (hash_mask 0), the others by a spatial hash.
struct GridLevel {
  float resolution;
  uint32_t dense_stride;  // corners along an axis
  uint32_t hash_mask;     // table size - 1, a power of two less one; 0: dense
};

template <class T>
HD Index<T> corner_index(const GridLevel& g, Index<T> x, Index<T> y, Index<T> z) {
  using I = Index<T>;
  if (g.hash_mask == 0) return x + I(g.dense_stride) * (y + I(g.dense_stride) * z);
  return (x ^ (y * I(2654435761u)) ^ (z * I(805459861u))) & I(g.hash_mask);
}

// The grid cell of a point, and the point's position in it.
template <class T>
struct GridCell {
  Index<T> x, y, z;  // lowest corner
  Vec3<T> t;         // position in the cell, [0, 1]

  HD GridCell(const GridLevel& g, Vec3<T> p) {
    const T half = T(0.5f * g.resolution), top = T(g.resolution - 1.0f);
    const Vec3<T> u{(p.x + T(1.0f)) * half, (p.y + T(1.0f)) * half, (p.z + T(1.0f)) * half};
    const Vec3<T> c{clamp(floor(u.x), T(0.0f), top), clamp(floor(u.y), T(0.0f), top),
                    clamp(floor(u.z), T(0.0f), top)};
    t = u - c;
    x = to_index<T>(c.x);
    y = to_index<T>(c.y);
    z = to_index<T>(c.z);
  }
  HD Index<T> corner(const GridLevel& g, int k) const {
    using I = Index<T>;
    return corner_index<T>(g, x + I(uint32_t(k & 1)), y + I(uint32_t(k >> 1 & 1)), z + I(uint32_t(k >> 2)));
  }
  HD T weight(int k) const { return axis(t.x, k & 1) * axis(t.y, k >> 1 & 1) * axis(t.z, k >> 2); }
  // derivatives of the weight with respect to p
  HD Vec3<T> weight_gradient(const GridLevel& g, int k) const {
    const T half = T(0.5f * g.resolution);
    const T wx = axis(t.x, k & 1), wy = axis(t.y, k >> 1 & 1), wz = axis(t.z, k >> 2);
    return {sign(k & 1, half) * wy * wz, wx * sign(k >> 1 & 1, half) * wz, wx * wy * sign(k >> 2, half)};
  }

 private:
  HD static T axis(T t, int upper) { return upper ? t : T(1.0f) - t; }
  HD static T sign(int upper, T s) { return upper ? s : -s; }
};

// The two interpolated features of a level at p. table: [corners][2]
template <class T>
HD void grid_eval(const GridLevel& g, const float* table, Vec3<T> p, T out[2]) {
  const GridCell<T> cell(g, p);
  out[0] = out[1] = T(0.0f);
  for (int k = 0; k < 8; ++k) {
    T a, b;
    gather2(table, cell.corner(g, k), a, b);
    const T w = cell.weight(k);
    out[0] = out[0] + w * a;
    out[1] = out[1] + w * b;
  }
}

// grid_eval() with spatial derivatives: out[feature][value, d/dx, d/dy, d/dz].
template <class T>
HD void grid_eval_jet(const GridLevel& g, const float* table, Vec3<T> p, T out[2][4]) {
  const GridCell<T> cell(g, p);
  for (int c = 0; c < 4; ++c) out[0][c] = out[1][c] = T(0.0f);
  for (int k = 0; k < 8; ++k) {
    T f[2];
    gather2(table, cell.corner(g, k), f[0], f[1]);
    const T w = cell.weight(k);
    const Vec3<T> d = cell.weight_gradient(g, k);
    for (int j = 0; j < 2; ++j) {
      out[j][0] = out[j][0] + w * f[j];
      out[j][1] = out[j][1] + d.x * f[j];
      out[j][2] = out[j][2] + d.y * f[j];
      out[j][3] = out[j][3] + d.z * f[j];
    }
  }
}

// Adjoint of grid_eval_jet with respect to the table (columns 1..3 are read only when columns == 4).
template <class T>
HD void grid_scatter(const GridLevel& g, float* d_table, Vec3<T> p, const T d_out[2][4], int columns) {
  const GridCell<T> cell(g, p);
  for (int k = 0; k < 8; ++k) {
    const T w = cell.weight(k);
    T a = w * d_out[0][0], b = w * d_out[1][0];
    if (columns == 4) {
      const Vec3<T> d = cell.weight_gradient(g, k);
      a = a + d.x * d_out[0][1] + d.y * d_out[0][2] + d.z * d_out[0][3];
      b = b + d.x * d_out[1][1] + d.y * d_out[1][2] + d.z * d_out[1][3];
    }
    scatter_add2(d_table, cell.corner(g, k), a, b);
  }
}

// sin and cos of 2^k x with their derivative by x: out[0] sin, out[1] cos.
template <class T>
HD void frequency_eval(T x, int k, T out[2], T d_out[2]) {
  const T scale = T(float(1 << k));
  T s, c;
  sin_cos(scale * x, s, c);
  out[0] = s;
  out[1] = c;
  d_out[0] = scale * c;
  d_out[1] = -(scale * s);
}

}  // namespace cei3d
