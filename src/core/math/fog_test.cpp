// SPDX-License-Identifier: Apache-2.0
#include "core/math/fog.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/math/dual.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

using D = Dual<double>;
constexpr int kCells = 6;
constexpr double kLength = 0.1;

template <class T>
struct Cell {
  T density;
  Vec3<T> color;
};

std::vector<Cell<double>> random_cells() {
  std::vector<Cell<double>> cells;
  for (uint64_t i = 0; i < kCells; ++i) {
    Rng rng(1, 0, i);
    cells.push_back({12 * rng.uniform(), {rng.uniform(), rng.uniform(), rng.uniform()}});
  }
  return cells;
}

template <class T>
FogTarget<T> target() {
  return {{T(0.2), T(0.6), T(0.4)}, T(0.3), T(0.7)};
}

template <class T>
T loss_of(const std::vector<Cell<T>>& cells) {
  Composite<T> seen = fog_ray<T>();
  for (const Cell<T>& c : cells) seen.add(fog_opacity(c.density, T(kLength)), c.color);
  return fog_loss(seen, target<T>());
}

// By the number that `member` (0: density, 1 to 3: color) says.
double by_dual_numbers(const std::vector<Cell<double>>& cells, size_t cell, int member) {
  std::vector<Cell<D>> d;
  for (const Cell<double>& c : cells) d.push_back({D(c.density), {D(c.color.x), D(c.color.y), D(c.color.z)}});
  (member == 0 ? d[cell].density : d[cell].color[member - 1]).derivative = 1;
  return loss_of(d).derivative;
}

TEST(Fog, GradientEqualsDualNumbers) {
  const std::vector<Cell<double>> cells = random_cells();
  Composite<double> seen = fog_ray<double>();
  std::vector<SampleWeight<double>> weights;
  for (const Cell<double>& c : cells) weights.push_back(seen.add(fog_opacity(c.density, kLength), c.color));
  FogGrad<double> grad(seen, target<double>(), kLength);
  for (size_t i = cells.size(); i-- > 0;) {
    const FogCellGrad<double> g =
        grad.add(fog_opacity(cells[i].density, kLength), weights[i], cells[i].color);
    const double by_density = by_dual_numbers(cells, i, 0);
    EXPECT_NEAR(g.d_density, by_density, 1e-12) << "cell " << i;
    EXPECT_GT(std::abs(by_density), 1e-5);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(g.d_color[c], by_dual_numbers(cells, i, 1 + c), 1e-12);
  }
}

// Cells in a row are one long cell, as in the law of Beer and Lambert.
TEST(Fog, OpacityIsThatOfTheSumOfDensities) {
  Composite<double> seen = fog_ray<double>();
  double sum = 0;
  for (const Cell<double>& c : random_cells()) {
    seen.add(fog_opacity(c.density, kLength), c.color);
    sum += c.density;
  }
  EXPECT_NEAR(seen.coverage, 1 - std::exp(-sum * kLength), 1e-12);
}

}  // namespace
}  // namespace cei3d
