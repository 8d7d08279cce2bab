// SPDX-License-Identifier: Apache-2.0
// Addresses in panels: [panel][row][32]. A jet's four columns (value, d/dx, d/dy, d/dz) are four consecutive
// panels.
#pragma once

#include <cstddef>

#include "core/compute/kernel.h"
#include "core/compute/linear.h"
#include "core/math/vec.h"

namespace cei3d {

// Sample i's place in row `row` of column `column` in a batch with `columns` panels a group of 32 samples.
HD size_t panel_at(int i, int columns, int column, int stride, int row) {
  return (size_t(i / kPanel * columns + column) * stride + row) * kPanel + i % kPanel;
}
template <class T>
HD Vec3<T> load_point(const float* points, int i) {  // [panels][3][32]
  const float* p = points + panel_at(i, 1, 0, 3, 0);
  return {load<T>(p), load<T>(p + kPanel), load<T>(p + 2 * kPanel)};
}

}  // namespace cei3d
