// SPDX-License-Identifier: Apache-2.0
// Sparse symmetric positive definite systems A x = b, factorized once and solved for any number of right-hand
// sides.
#pragma once

#include <memory>
#include <span>
#include <vector>

namespace cei3d {

struct SparseEntry {
  int row = 0, column = 0;
  double value = 0;
};

class SparseSolver {
 public:
  // Factorizes the n x n matrix whose elements are the sums of the entries at their position. Entries above
  // the diagonal are ignored, so pass the lower triangle or the whole matrix. One thread; deterministic. Time
  // and memory on the graph of a surface: about n log n. Errors: an entry outside the matrix; a matrix that
  // is not positive definite (a Laplacian with nothing fixed).
  SparseSolver(int n, std::span<const SparseEntry> entries);
  SparseSolver(SparseSolver&&) noexcept;
  SparseSolver& operator=(SparseSolver&&) noexcept;
  ~SparseSolver();

  int size() const;
  // right_hand_sides: [columns][n]. Returns the solutions in the same layout.
  std::vector<double> solve(std::span<const double> right_hand_sides, int columns = 1) const;

 private:
  struct Factor;
  std::unique_ptr<Factor> factor_;
};

}  // namespace cei3d
