// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/sparse.h"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace cei3d {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

Matrix lower_triangle(int n, std::span<const SparseEntry> entries) {
  std::vector<Eigen::Triplet<double>> triplets;
  triplets.reserve(entries.size());
  for (const SparseEntry& e : entries) {
    if (e.row < 0 || e.row >= n || e.column < 0 || e.column >= n)
      fail("A sparse matrix of size {} has no entry ({}, {}) (an error in the program).", n, e.row, e.column);
    if (e.row >= e.column) triplets.emplace_back(e.row, e.column, e.value);
  }
  Matrix a(n, n);
  a.setFromTriplets(triplets.begin(), triplets.end());
  return a;
}

}  // namespace

struct SparseSolver::Factor {
  Eigen::SimplicialLLT<Matrix, Eigen::Lower> llt;
};

SparseSolver::SparseSolver(int n, std::span<const SparseEntry> entries)
    : factor_(std::make_unique<Factor>()) {
  factor_->llt.compute(lower_triangle(n, entries));
  if (factor_->llt.info() != Eigen::Success)
    fail(
        "A linear system of {} unknowns is not positive definite: parts of it hang on nothing that is fixed.",
        n);
}

SparseSolver::SparseSolver(SparseSolver&&) noexcept = default;
SparseSolver& SparseSolver::operator=(SparseSolver&&) noexcept = default;
SparseSolver::~SparseSolver() = default;

int SparseSolver::size() const { return int(factor_->llt.rows()); }

std::vector<double> SparseSolver::solve(std::span<const double> right_hand_sides, int columns) const {
  const size_t n = size_t(size());
  if (right_hand_sides.size() != n * size_t(columns))
    fail(
        "A linear system of {} unknowns and {} right-hand sides was given {} numbers (an error in the "
        "program).",
        n, columns, right_hand_sides.size());
  std::vector<double> x(right_hand_sides.size());
  parallel_for(columns, [&](int c) {
    const Eigen::Map<const Vector> b(right_hand_sides.data() + size_t(c) * n, Eigen::Index(n));
    Eigen::Map<Vector>(x.data() + size_t(c) * n, Eigen::Index(n)) = factor_->llt.solve(b);
  });
  return x;
}

}  // namespace cei3d
