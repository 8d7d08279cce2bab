// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/adjacency.h"
#include "model/geometry/mesh/patch.h"
#include "model/geometry/mesh/sparse.h"

namespace cei3d {
namespace {

// Minimizes a quadratic form over vertex values, given those of the fixed vertices: the free rows of A x = 0.
class Relaxation {
 public:
  explicit Relaxation(std::span<const uint8_t> free) : index_(free.size(), -1) {
    for (uint32_t v = 0; v < free.size(); ++v)
      if (free[v]) index_[v] = int(list_.size()), list_.push_back(v);
  }
  bool empty() const { return list_.empty(); }
  const std::vector<uint32_t>& list() const { return list_; }

  // values: those of the fixed vertices are read.
  void add(uint32_t row, uint32_t column, double value, std::span<const Vec3f> values) {
    if (index_[row] < 0) return;
    if (index_[column] >= 0) {
      if (index_[row] >= index_[column]) entries_.push_back({index_[row], index_[column], value});
      return;
    }
    right_.resize(3 * list_.size(), 0.0);
    for (int c = 0; c < 3; ++c) right_[c * list_.size() + index_[row]] -= value * double(values[column][c]);
  }

  void solve(std::vector<Vec3f>& values) {
    const size_t n = list_.size();
    right_.resize(3 * n, 0.0);
    const std::vector<double> x = SparseSolver(int(n), entries_).solve(right_, 3);
    for (size_t i = 0; i < n; ++i) values[list_[i]] = {float(x[i]), float(x[n + i]), float(x[2 * n + i])};
  }

 private:
  std::vector<int> index_;
  std::vector<uint32_t> list_;
  std::vector<SparseEntry> entries_;
  std::vector<double> right_;  // [3][#free]
};

struct Laplacian {
  VertexLists neighbors;
  LaplaceWeights weights;

  Laplacian(std::span<const Vec3f> positions, std::span<const std::array<uint32_t, 3>> triangles)
      : neighbors(neighbors_of(positions.size(), triangles)),
        weights(laplace_weights(positions, triangles, neighbors)) {}

  std::vector<std::pair<uint32_t, double>> row(uint32_t v) const {
    std::vector<std::pair<uint32_t, double>> r{{v, weights.vertex[v]}};
    for (uint32_t i = neighbors.start[v]; i < neighbors.start[v + 1]; ++i)
      r.emplace_back(neighbors.items[i], -weights.edge[i]);
    return r;
  }
};

}  // namespace

void fair(std::vector<Vec3f>& positions, std::span<const std::array<uint32_t, 3>> triangles,
          std::span<const uint8_t> free, float bending_length) {
  for (int round = 0; round < 2; ++round) {  // the second with the weights of the faired shape
    Relaxation relaxation(free);
    if (relaxation.empty()) return;
    const Laplacian laplacian(positions, triangles);
    for (uint32_t v = 0; v < positions.size(); ++v) {
      const auto row = laplacian.row(v);
      const double stiffness = double(bending_length) * bending_length / laplacian.weights.area[v];
      for (const auto& [u, w] : row) relaxation.add(v, u, w, positions);
      for (const auto& [a, wa] : row)
        for (const auto& [b, wb] : row) relaxation.add(a, b, wa * wb * stiffness, positions);
    }
    relaxation.solve(positions);
  }
}

void diffuse(std::span<const Vec3f> positions, std::span<const std::array<uint32_t, 3>> triangles,
             std::span<const uint8_t> free, std::vector<Vec3f>& values) {
  Relaxation relaxation(free);
  if (relaxation.empty()) return;
  const Laplacian laplacian(positions, triangles);
  for (const uint32_t v : relaxation.list())
    for (const auto& [u, w] : laplacian.row(v)) relaxation.add(v, u, w, values);
  relaxation.solve(values);
}

}  // namespace cei3d
