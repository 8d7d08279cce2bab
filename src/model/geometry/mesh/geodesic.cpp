// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/geodesic.h"

#include <cmath>
#include <queue>

#include "model/geometry/mesh/adjacency.h"

namespace cei3d {
namespace {

// Distance of corner p from a point source that is da from corner a and db from corner b: the source is
// placed in the triangle's plane, beyond the edge ab. Uses the paths along the edges where the straight path
// would leave the triangle.
double unfolded_distance(Vec3d p, Vec3d a, Vec3d b, double da, double db) {
  const double along_edges = min(da + length(p - a), db + length(p - b));
  const double base = length(b - a);
  if (base <= 0) return along_edges;
  const Vec3d x = (b - a) / base, ap = p - a;
  const double px = dot(ap, x), py = length(ap - x * px);  // p, in a frame with a at 0 and b on the x axis
  const double sx = (da * da - db * db + base * base) / (2 * base), sy2 = da * da - sx * sx;
  if (!(sy2 >= 0)) return along_edges;
  const double sy = -std::sqrt(sy2);
  const double crossing = py - sy > 0 ? sx + (px - sx) * (-sy / (py - sy)) : -1;  // where the path crosses ab
  if (crossing < 0 || crossing > base) return along_edges;
  return min(along_edges, std::hypot(px - sx, py - sy));
}

struct Front {
  float distance;
  uint32_t vertex;
  bool operator>(const Front& o) const {
    return distance != o.distance ? distance > o.distance : vertex > o.vertex;
  }
};

}  // namespace

std::vector<float> geodesic_distances(std::span<const Vec3f> positions,
                                      std::span<const std::array<uint32_t, 3>> triangles, uint32_t source,
                                      const GeodesicLimits& limits) {
  const VertexLists around = triangles_around(positions.size(), triangles);
  std::vector<float> distance(positions.size(), kUnreached);
  std::vector<uint8_t> settled(positions.size(), 0);
  std::priority_queue<Front, std::vector<Front>, std::greater<>> front;
  distance[source] = 0;
  front.push({0, source});
  const auto reach = [&](uint32_t v, double d) {
    if (settled[v] || d >= distance[v] || d > limits.farthest) return;
    if (limits.may_enter && !limits.may_enter(v)) return;
    distance[v] = float(d);
    front.push({float(d), v});
  };
  while (!front.empty()) {
    const auto [d, v] = front.top();
    front.pop();
    if (settled[v]) continue;
    settled[v] = 1;
    for (const uint32_t i : around.of(v)) {
      const auto& t = triangles[i];
      const int k = t[0] == v ? 0 : t[1] == v ? 1 : 2;
      const uint32_t a = t[(k + 1) % 3], b = t[(k + 2) % 3];
      const Vec3d pv = to_double(positions[v]), pa = to_double(positions[a]), pb = to_double(positions[b]);
      reach(a, settled[b] ? unfolded_distance(pa, pv, pb, d, distance[b]) : d + length(pa - pv));
      reach(b, settled[a] ? unfolded_distance(pb, pv, pa, d, distance[a]) : d + length(pb - pv));
    }
  }
  return distance;
}

}  // namespace cei3d
