// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/sparse.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/math/rng.h"

namespace cei3d {
namespace {

// Gaussian elimination with pivoting on a dense matrix [n][n].
std::vector<double> dense_solve(std::vector<double> a, std::vector<double> b) {
  const int n = int(b.size());
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k; i < n; ++i)
      if (std::abs(a[i * n + k]) > std::abs(a[pivot * n + k])) pivot = i;
    for (int j = 0; j < n; ++j) std::swap(a[k * n + j], a[pivot * n + j]);
    std::swap(b[k], b[pivot]);
    for (int i = k + 1; i < n; ++i) {
      const double f = a[i * n + k] / a[k * n + k];
      for (int j = k; j < n; ++j) a[i * n + j] -= f * a[k * n + j];
      b[i] -= f * b[k];
    }
  }
  for (int i = n - 1; i >= 0; --i) {
    for (int j = i + 1; j < n; ++j) b[i] -= a[i * n + j] * b[j];
    b[i] /= a[i * n + i];
  }
  return b;
}

struct System {
  std::vector<SparseEntry> entries;  // whole matrix, in pieces that add up
  std::vector<double> dense;         // [n][n]
};

void add(System& s, int n, int row, int column, double value) {
  s.entries.push_back({row, column, value});
  s.dense[row * n + column] += value;
}

// Laplacian of a random graph with random weights, a little of the identity added.
System random_laplacian(int n) {
  System s{{}, std::vector<double>(size_t(n) * n, 0.0)};
  for (int i = 0; i < n; ++i) add(s, n, i, i, 0.01);
  for (int k = 0; k < 4 * n; ++k) {
    Rng rng(3, 0, k);
    const int i = int(rng.below(n)), j = int(rng.below(n));
    const double w = 0.1 + rng.uniform();
    if (i == j) continue;
    add(s, n, i, i, w);
    add(s, n, j, j, w);
    add(s, n, i, j, -w);
    add(s, n, j, i, -w);
  }
  return s;
}

TEST(SparseSolver, AgreesWithDenseElimination) {
  constexpr int n = 60, columns = 3;
  const System system = random_laplacian(n);
  const SparseSolver solver(n, system.entries);
  EXPECT_EQ(solver.size(), n);
  std::vector<double> b(n * columns);
  for (int i = 0; i < n * columns; ++i) b[i] = Rng(4, 0, i).normal();
  const std::vector<double> x = solver.solve(b, columns);
  for (int c = 0; c < columns; ++c) {
    const std::vector<double> expected =
        dense_solve(system.dense, {b.begin() + c * n, b.begin() + (c + 1) * n});
    for (int i = 0; i < n; ++i) EXPECT_NEAR(x[c * n + i], expected[i], 1e-9) << c << ' ' << i;
  }
}

TEST(SparseSolver, TakesTheLowerTriangleAlone) {
  constexpr int n = 20;
  const System system = random_laplacian(n);
  std::vector<SparseEntry> lower;
  for (const SparseEntry& e : system.entries)
    if (e.row >= e.column) lower.push_back(e);
  const std::vector<double> b(n, 1.0);
  EXPECT_EQ(SparseSolver(n, lower).solve(b), SparseSolver(n, system.entries).solve(b));
}

TEST(SparseSolver, RefusesWhatHasNoSingleSolution) {
  const std::vector<SparseEntry> floating{
      {0, 0, 1}, {1, 0, -1}, {1, 1, 1}};  // two nodes, one spring, nothing fixed
  EXPECT_THROW(SparseSolver(2, floating), Error);
  const std::vector<SparseEntry> outside{{2, 0, 1}};
  EXPECT_THROW(SparseSolver(2, outside), Error);
  const std::vector<SparseEntry> one{{0, 0, 1}};
  EXPECT_THROW(SparseSolver(1, one).solve(std::vector<double>(2)), Error);
}

}  // namespace
}  // namespace cei3d
