// SPDX-License-Identifier: Apache-2.0
// Encodings of a batch of points. A launch does one hash level or one frequency, so that the table of a level
// stays in cache.
#pragma once

#include "core/compute/kernel.h"
#include "core/compute/kernels/panel.h"
#include "core/math/encoding.h"

namespace cei3d {

struct EncodeArgs {
  const float* points;  // [panels][3][32], in [-1, 1]
  float* out;           // panels of `stride` rows; this launch writes rows from `row` on
  int stride, row;
  int columns;  // 1: values; 4: jets
};

// Rows row..row+2: the point itself.
struct EncodePoint {
  using Args = EncodeArgs;
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> p = load_point<T>(a.points, i);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < a.columns; ++c)
        store<T>(a.out + panel_at(i, a.columns, c, a.stride, a.row + r),
                 c == 0 ? p[r] : T(c == r + 1 ? 1.0f : 0.0f));
  }
};

// Rows row..row+5: sin and cos of 2^k x, then of y, of z.
struct EncodeFrequency {
  struct Args : EncodeArgs {
    int k;
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> p = load_point<T>(a.points, i);
    for (int axis = 0; axis < 3; ++axis) {
      T value[2], d_p[2];
      frequency_eval(p[axis], a.k, value, d_p);
      for (int j = 0; j < 2; ++j)
        for (int c = 0; c < a.columns; ++c)
          store<T>(a.out + panel_at(i, a.columns, c, a.stride, a.row + 2 * axis + j), c == 0 ? value[j]
                                                                                      : c == axis + 1
                                                                                          ? d_p[j]
                                                                                          : T(0.0f));
    }
  }
};

// Rows row, row+1: the two features of the level.
struct EncodeGrid {
  struct Args : EncodeArgs {
    GridLevel level;
    const float* table;  // [corners][2]
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    const Vec3<T> p = load_point<T>(a.points, i);
    if (a.columns == 1) {
      T f[2];
      grid_eval(a.level, a.table, p, f);
      for (int j = 0; j < 2; ++j) store<T>(a.out + panel_at(i, 1, 0, a.stride, a.row + j), f[j]);
    } else {
      T f[2][4];
      grid_eval_jet(a.level, a.table, p, f);
      for (int j = 0; j < 2; ++j)
        for (int c = 0; c < 4; ++c) store<T>(a.out + panel_at(i, 4, c, a.stride, a.row + j), f[j][c]);
    }
  }
};

// Adjoint of EncodeGrid with respect to the table.
struct EncodeGradArgs {
  const float* points;  // [panels][3][32], in [-1, 1]
  const float* d_out;   // panels of `stride` rows; this launch reads rows from `row` on
  int stride, row;
  int columns;  // 1: values; 4: jets
};
struct EncodeGridGrad {
  struct Args : EncodeGradArgs {
    GridLevel level;
    float* d_table;  // [corners][2], added to
  };
  template <class T>
  static HD void run(const Args& a, int i) {
    T d[2][4];
    for (int j = 0; j < 2; ++j)
      for (int c = 0; c < a.columns; ++c)
        d[j][c] = load<T>(a.d_out + panel_at(i, a.columns, c, a.stride, a.row + j));
    grid_scatter(a.level, a.d_table, load_point<T>(a.points, i), d, a.columns);
  }
};

}  // namespace cei3d
