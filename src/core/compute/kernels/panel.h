// SPDX-License-Identifier: Apache-2.0
// Addresses in panels: [panel][row][32]. The four columns of a jet (value, d/dx, d/dy, d/dz) are four
// consecutive panels.
#pragma once

#include <cstddef>

#include "core/compute/linear.h"
#include "core/math/scalar.h"
#include "core/math/vec.h"

namespace cei3d {

// The place of sample i in row `row` of column `column`. columns: panels per group of 32 samples; stride:
// rows per panel.
HD size_t panel_at(int i, int columns, int column, int stride, int row) {
  return (size_t(i / kPanel * columns + column) * stride + row) * kPanel + i % kPanel;
}
template <class T>
HD Vec3<T> load_point(const float* points, int i) {  // [panels][3][32]
  const float* p = points + panel_at(i, 1, 0, 3, 0);
  return {load<T>(p), load<T>(p + kPanel), load<T>(p + 2 * kPanel)};
}
HD void store_point(float* points, int i, Vec3f v) {  // [panels][3][32]
  for (int c = 0; c < 3; ++c) points[panel_at(i, 1, 0, 3, c)] = v[c];
}

// The spatial gradient of output 0 of sample i. jets: [panels * 4][rows][32]
template <class T>
HD Vec3<T> load_sdf_gradient(const float* jets, int i, int rows) {
  return {load<T>(jets + panel_at(i, 4, 1, rows, 0)), load<T>(jets + panel_at(i, 4, 2, rows, 0)),
          load<T>(jets + panel_at(i, 4, 3, rows, 0))};
}

// Output 0 of a batch of jets, [panels * 4][rows][32]: a signed distance and its spatial gradient.
struct JetView {
  const float* jets;
  int rows;
  HD float value(int i) const { return jets[panel_at(i, 4, 0, rows, 0)]; }
  HD Vec3f gradient(int i) const { return load_sdf_gradient<float>(jets, i, rows); }
};

// The gradients of a loss with respect to output 0 of a batch of jets.
struct JetGradView {
  float* d_jets;
  int rows;
  HD void add_value(int i, float d) const { d_jets[panel_at(i, 4, 0, rows, 0)] += d; }
  HD void add_gradient(int i, Vec3f d) const {
    for (int c = 0; c < 3; ++c) d_jets[panel_at(i, 4, 1 + c, rows, 0)] += d[c];
  }
};

}  // namespace cei3d
