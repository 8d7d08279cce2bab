// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/unwrap/outline.h"

#include <algorithm>
#include <cmath>

namespace cei3d {

std::vector<Vec2d> convex_hull(std::vector<Vec2d> p) {
  std::sort(p.begin(), p.end(), [](Vec2d a, Vec2d b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  std::vector<Vec2d> hull;
  for (int side = 0; side < 2; ++side) {
    const size_t start = hull.size();
    for (const Vec2d& q : p) {
      while (hull.size() >= start + 2 &&
             signed_area(hull.back() - hull[hull.size() - 2], q - hull[hull.size() - 2]) <= 0)
        hull.pop_back();
      hull.push_back(q);
    }
    if (!hull.empty()) hull.pop_back();
    std::reverse(p.begin(), p.end());
  }
  return hull;
}

double area_of(const FlatPiece& piece) {
  double sum = 0;
  const auto& p = piece.points;
  for (const auto& [a, b, c] : piece.triangles) sum += std::abs(signed_area(p[b] - p[a], p[c] - p[a])) / 2;
  return sum;
}

double fullness(const FlatPiece& piece) {
  const std::vector<Vec2d> hull = convex_hull(piece.points);
  double area = 0;
  for (size_t i = 1; i + 1 < hull.size(); ++i)
    area += signed_area(hull[i] - hull[0], hull[i + 1] - hull[0]) / 2;
  return area > 0 ? area_of(piece) / area : 0;
}

}  // namespace cei3d
