// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/arap.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "core/base/parallel.h"
#include "model/geometry/mesh/adjacency.h"
#include "model/geometry/mesh/rotation.h"
#include "model/geometry/mesh/sparse.h"

namespace cei3d {
namespace {

constexpr int kGrain = 1024;

// Free vertices that are not connected to a held one have no defined position, so they are not freed.
std::vector<uint8_t> anchored(const VertexLists& neighbors, const std::vector<uint8_t>& free) {
  std::vector<uint8_t> reached(free.size(), 0);
  std::vector<uint32_t> queue;
  const auto visit = [&](uint32_t v) {
    if (!free[v] || reached[v]) return;
    reached[v] = 1;
    queue.push_back(v);
  };
  for (uint32_t v = 0; v < free.size(); ++v)
    if (!free[v])
      for (const uint32_t u : neighbors.of(v)) visit(u);
  while (!queue.empty()) {
    const uint32_t v = queue.back();
    queue.pop_back();
    for (const uint32_t u : neighbors.of(v)) visit(u);
  }
  return reached;
}

Mat3d outer(Vec3d a, Vec3d b) { return {{b * a.x, b * a.y, b * a.z}}; }

void add(Mat3d& sum, const Mat3d& m, double scale) {
  for (int i = 0; i < 3; ++i) sum.row[i] += m.row[i] * scale;
}

class Descent {
 public:
  Descent(std::span<const Vec3f> positions, std::span<const std::array<uint32_t, 3>> triangles,
          const ArapConstraints& constraints, double bending_length)
      : neighbors_(neighbors_of(positions.size(), triangles)),
        weights_(laplace_weights(positions, triangles, neighbors_)),
        free_(anchored(neighbors_, constraints.free)),
        bending_(bending_length * bending_length) {
    for (const Vec3f p : positions) rest_.push_back(to_double(p));
    now_ = rest_;
    for (size_t i = 0; i < constraints.handles.size(); ++i)
      now_[constraints.handles[i]] = to_double(constraints.targets[i]);
    list_cells(constraints);
    rotation_.assign(rest_.size(), Mat3d::identity());
    bend_.assign(rest_.size(), Vec3d{0, 0, 0});
    if (!free_list_.empty()) solver_.emplace(int(free_list_.size()), system());
  }

  const std::vector<Vec3d>& positions() const { return now_; }
  const std::vector<uint32_t>& free_list() const { return free_list_; }

  // Minimum of the energy for fixed rotations: one Newton step on a quadratic.
  void move() {
    const size_t n = free_list_.size();
    for_each(cells_, [&](uint32_t v) { bend_[v] = bending(v); });
    std::vector<double> right(3 * n);
    parallel_ranges(int(n), kGrain, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) {
        const Vec3d g = half_gradient(free_list_[i]);
        right[i] = -g.x, right[n + i] = -g.y, right[2 * n + i] = -g.z;
      }
    });
    const std::vector<double> step = solver_->solve(right, 3);
    for (size_t i = 0; i < n; ++i) now_[free_list_[i]] += Vec3d{step[i], step[n + i], step[2 * n + i]};
  }

  // Minimum of the energy for fixed positions.
  void rotate() {
    for_each(turning_, [&](uint32_t v) {
      Mat3d s{};
      for (uint32_t i = neighbors_.start[v]; i < neighbors_.start[v + 1]; ++i) {
        const uint32_t u = neighbors_.items[i];
        add(s, outer(now_[v] - now_[u], rest_[v] - rest_[u]), weights_.edge[i]);
      }
      add(s, outer(laplacian(now_, v), laplacian(rest_, v)), bending_ / weights_.area[v]);
      rotation_[v] = nearest_rotation(s);
    });
  }

  double energy() const {
    const int n = int(cells_.size()), chunks = (n + kGrain - 1) / kGrain;
    std::vector<double> sums(chunks, 0.0);
    parallel_for(chunks, [&](int c) {
      for (int i = c * kGrain; i < std::min(n, (c + 1) * kGrain); ++i) sums[c] += cell_energy(cells_[i]);
    });
    return std::accumulate(sums.begin(), sums.end(), 0.0);
  }

 private:
  template <class F>
  static void for_each(const std::vector<uint32_t>& list, F visit) {
    parallel_ranges(int(list.size()), kGrain, [&](int begin, int end) {
      for (int i = begin; i < end; ++i) visit(list[i]);
    });
  }

  // Cells are the vertices whose energy depends on free vertices; the rotations of those that are not fixed
  // are unknowns.
  void list_cells(const ArapConstraints& constraints) {
    std::vector<uint8_t> fixed(free_.size());
    for (size_t v = 0; v < free_.size(); ++v) fixed[v] = !free_[v];
    for (const uint32_t v : constraints.handles) fixed[v] = 0;
    index_.assign(free_.size(), -1);
    for (uint32_t v = 0; v < free_.size(); ++v) {
      const auto ring = neighbors_.of(v);
      if (free_[v]) {
        index_[v] = int(free_list_.size());
        free_list_.push_back(v);
      } else if (std::none_of(ring.begin(), ring.end(), [&](uint32_t u) { return free_[u]; })) {
        continue;
      }
      cells_.push_back(v);
      if (!fixed[v]) turning_.push_back(v);
    }
  }

  Vec3d laplacian(const std::vector<Vec3d>& p, uint32_t v) const {
    Vec3d sum{0, 0, 0};
    for (uint32_t i = neighbors_.start[v]; i < neighbors_.start[v + 1]; ++i)
      sum += (p[v] - p[neighbors_.items[i]]) * weights_.edge[i];
    return sum;
  }

  // b^2 / A (d(p) - R d(q)).
  Vec3d bending(uint32_t v) const {
    return (laplacian(now_, v) - rotation_[v] * laplacian(rest_, v)) * (bending_ / weights_.area[v]);
  }

  Vec3d half_gradient(uint32_t v) const {
    Vec3d g = bend_[v] * weights_.vertex[v];
    for (uint32_t i = neighbors_.start[v]; i < neighbors_.start[v + 1]; ++i) {
      const uint32_t u = neighbors_.items[i];
      const Vec3d edge = rest_[v] - rest_[u];
      const Vec3d strain = (now_[v] - now_[u]) * 2.0 - rotation_[v] * edge - rotation_[u] * edge;
      g += (strain - bend_[u]) * weights_.edge[i];
    }
    return g;
  }

  double cell_energy(uint32_t v) const {
    double e = 0;
    for (uint32_t i = neighbors_.start[v]; i < neighbors_.start[v + 1]; ++i) {
      const uint32_t u = neighbors_.items[i];
      const Vec3d strain = now_[v] - now_[u] - rotation_[v] * (rest_[v] - rest_[u]);
      e += weights_.edge[i] * dot(strain, strain);
    }
    if (bending_ == 0) return e;
    const Vec3d bend = bending(v);
    return e + dot(bend, bend) * weights_.area[v] / bending_;
  }

  // 2 L + b^2 L A^-1 L, over the free vertices.
  std::vector<SparseEntry> system() const {
    std::vector<SparseEntry> entries;
    const auto put = [&](uint32_t row, uint32_t column, double value) {
      if (index_[row] >= 0 && index_[column] >= 0 && index_[row] >= index_[column])
        entries.push_back({index_[row], index_[column], value});
    };
    std::vector<std::pair<uint32_t, double>> row;  // of L
    for (const uint32_t v : cells_) {
      row.assign(1, {v, weights_.vertex[v]});
      for (uint32_t i = neighbors_.start[v]; i < neighbors_.start[v + 1]; ++i)
        row.emplace_back(neighbors_.items[i], -weights_.edge[i]);
      for (const auto& [u, w] : row) put(v, u, 2 * w);
      if (bending_ == 0) continue;
      for (const auto& [a, wa] : row)
        for (const auto& [b, wb] : row) put(a, b, bending_ / weights_.area[v] * wa * wb);
    }
    return entries;
  }

  VertexLists neighbors_;
  LaplaceWeights weights_;
  std::vector<uint8_t> free_;
  double bending_;  // b^2
  std::vector<uint32_t> free_list_, cells_, turning_;
  std::vector<int> index_;  // place in free_list_; -1: not free
  std::vector<Vec3d> rest_, now_, bend_;
  std::vector<Mat3d> rotation_;
  std::optional<SparseSolver> solver_;  // none when nothing is free
};

}  // namespace

ArapResult arap_deform(std::span<const Vec3f> positions, std::span<const std::array<uint32_t, 3>> triangles,
                       const ArapConstraints& constraints, const ArapOptions& options) {
  ArapResult result{{positions.begin(), positions.end()}, {}};
  for (size_t i = 0; i < constraints.handles.size(); ++i)
    result.positions[constraints.handles[i]] = constraints.targets[i];
  Descent descent(positions, triangles, constraints, options.bending_length);
  if (descent.free_list().empty()) return result;
  for (int i = 0; i < options.max_iterations; ++i) {
    descent.move();
    descent.rotate();
    result.energies.push_back(descent.energy());
    const size_t n = result.energies.size();
    if (n > 1 &&
        result.energies[n - 2] - result.energies[n - 1] <= options.tolerance * result.energies[n - 2])
      break;
  }
  for (const uint32_t v : descent.free_list()) result.positions[v] = to_float(descent.positions()[v]);
  return result;
}

}  // namespace cei3d
