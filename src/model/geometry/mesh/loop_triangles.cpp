// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/loop_triangles.h"

#include <cmath>
#include <limits>

namespace cei3d {
namespace {

constexpr size_t kMaxCorners = 200;  // time grows with the cube

using Triangles = std::vector<std::array<uint32_t, 3>>;

// Dynamic programming over the sub-polygons i .. j, whose last side is the diagonal j -> i.
class MinArea {
 public:
  // corners: indices into the loop, in its order.
  MinArea(std::span<const Vec3f> loop, std::vector<uint32_t> corners, const IsJoined& joined)
      : loop_(loop), corners_(std::move(corners)), n_(corners_.size()), cost_(n_ * n_, 0), apex_(n_ * n_, 0) {
    for (size_t span = 2; span < n_; ++span)
      for (size_t i = 0; i + span < n_; ++i) solve(i, i + span, joined);
  }

  void collect(Triangles& out) const {
    std::vector<std::pair<size_t, size_t>> open{{0, n_ - 1}};
    while (!open.empty()) {
      const auto [i, j] = open.back();
      open.pop_back();
      if (j - i < 2) continue;
      const size_t k = apex_[i * n_ + j];
      out.push_back({corners_[i], corners_[k], corners_[j]});
      open.emplace_back(i, k);
      open.emplace_back(k, j);
    }
  }

 private:
  void solve(size_t i, size_t j, const IsJoined& joined) {
    double best = std::numeric_limits<double>::infinity();
    for (size_t k = i + 1; k < j; ++k) {
      const double c = cost_[i * n_ + k] + cost_[k * n_ + j] + cost(i, k, j);
      if (c < best) best = c, apex_[i * n_ + j] = k;
    }
    const bool is_side = i == 0 && j == n_ - 1;
    cost_[i * n_ + j] = best + (!is_side && joined(corners_[i], corners_[j]) ? kJoinedCost : 0);
  }

  // Area plus a small multiple of the squared edge lengths: prefers rounder triangles among equal areas.
  double cost(size_t i, size_t k, size_t j) const {
    const Vec3d a = at(i), b = at(k), c = at(j);
    const Vec3d u = b - a, v = c - b, w = a - c;
    return 0.5 * length(cross(u, v)) + 1e-4 * (dot(u, u) + dot(v, v) + dot(w, w));
  }
  Vec3d at(size_t i) const { return to_double(loop_[corners_[i]]); }

  static constexpr double kJoinedCost = 1e3;  // more than any area in the unit sphere
  std::span<const Vec3f> loop_;
  std::vector<uint32_t> corners_;
  size_t n_;
  std::vector<double> cost_;
  std::vector<size_t> apex_;
};

}  // namespace

std::vector<std::array<uint32_t, 3>> triangulate_loop(std::span<const Vec3f> loop, const IsJoined& joined) {
  Triangles triangles;
  const size_t n = loop.size(), stride = (n + kMaxCorners - 1) / kMaxCorners;
  const auto taken = [&](size_t a, size_t b) { return b - a > 1 && joined(uint32_t(a), uint32_t(b % n)); };
  std::vector<uint32_t> chords;
  for (size_t begin = 0, end; begin < n; begin = end) {
    end = std::min(begin + stride, n);
    while (end < n && taken(begin, end)) ++end;
    chords.push_back(uint32_t(begin));
    std::vector<uint32_t> run;
    for (size_t k = begin; k <= end; ++k) run.push_back(uint32_t(k % n));
    if (run.size() > 2) MinArea(loop, std::move(run), joined).collect(triangles);
  }
  MinArea(loop, std::move(chords), joined).collect(triangles);
  return triangles;
}

}  // namespace cei3d
