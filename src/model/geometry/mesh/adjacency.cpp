// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/adjacency.h"

#include <algorithm>

namespace cei3d {
namespace {

constexpr double kMinWeight = 0.05, kMaxWeight = 5;  // an edge between equilateral triangles has 0.58

// The lists of items by vertex, in the order in which for_each_item(add) calls add(vertex, item). It is
// called twice and does the same both times.
template <class ForEachItem>
VertexLists lists_of(size_t vertices, const ForEachItem& for_each_item) {
  VertexLists lists;
  lists.start.assign(vertices + 1, 0);
  for_each_item([&](uint32_t v, uint32_t) { ++lists.start[v + 1]; });
  for (size_t v = 0; v < vertices; ++v) lists.start[v + 1] += lists.start[v];
  lists.items.resize(lists.start.back());
  std::vector<uint32_t> next(lists.start.begin(), lists.start.end() - 1);
  for_each_item([&](uint32_t v, uint32_t item) { lists.items[next[v]++] = item; });
  return lists;
}

// Position of v in the list of u.
size_t slot(const VertexLists& neighbors, uint32_t u, uint32_t v) {
  const auto begin = neighbors.items.begin() + neighbors.start[u];
  const auto end = neighbors.items.begin() + neighbors.start[u + 1];
  return size_t(std::lower_bound(begin, end, v) - neighbors.items.begin());
}

}  // namespace

VertexLists triangles_around(size_t vertices, std::span<const std::array<uint32_t, 3>> triangles) {
  return lists_of(vertices, [&](const auto& add) {
    for (size_t i = 0; i < triangles.size(); ++i)
      for (const uint32_t v : triangles[i]) add(v, uint32_t(i));
  });
}

VertexLists neighbors_of(size_t vertices, std::span<const std::array<uint32_t, 3>> triangles) {
  const VertexLists around = triangles_around(vertices, triangles);
  VertexLists lists;
  lists.start.assign(vertices + 1, 0);
  std::vector<uint32_t> ring;
  for (uint32_t v = 0; v < vertices; ++v) {
    ring.clear();
    for (const uint32_t i : around.of(v))
      for (const uint32_t u : triangles[i])
        if (u != v) ring.push_back(u);
    std::sort(ring.begin(), ring.end());
    lists.items.insert(lists.items.end(), ring.begin(), std::unique(ring.begin(), ring.end()));
    lists.start[v + 1] = uint32_t(lists.items.size());
  }
  return lists;
}

std::vector<Edge> edges_of(std::span<const std::array<uint32_t, 3>> triangles) {
  std::vector<Edge> edges;
  for (const auto& t : triangles)
    for (int c = 0; c < 3; ++c)
      if (t[c] < t[(c + 1) % 3]) edges.push_back({t[c], t[(c + 1) % 3]});
  return edges;
}

VertexLists joined_by(size_t vertices, std::span<const Edge> edges) {
  return lists_of(vertices, [&](const auto& add) {
    for (const auto& [a, b] : edges) add(a, b), add(b, a);
  });
}

LaplaceWeights laplace_weights(std::span<const Vec3f> positions,
                               std::span<const std::array<uint32_t, 3>> triangles,
                               const VertexLists& neighbors) {
  const size_t n = positions.size();
  LaplaceWeights w{std::vector<double>(neighbors.items.size(), 0.0), std::vector<double>(n, 0.0),
                   std::vector<double>(n, 0.0)};
  double total_area = 0;
  for (const auto& t : triangles)
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = t[k], b = t[(k + 1) % 3], c = t[(k + 2) % 3];
      const Vec3d u = to_double(positions[b] - positions[a]), v = to_double(positions[c] - positions[a]);
      const double twice_area = length(cross(u, v)), cotangent = dot(u, v) / max(twice_area, 1e-12);
      w.edge[slot(neighbors, b, c)] += 0.5 * cotangent;
      w.edge[slot(neighbors, c, b)] += 0.5 * cotangent;
      w.area[a] += twice_area / 6;
      total_area += twice_area / 6;
    }
  for (double& e : w.edge) e = std::clamp(e, kMinWeight, kMaxWeight);
  for (uint32_t v = 0; v < n; ++v) {
    w.area[v] = max(w.area[v], 0.1 * total_area / double(n));
    for (uint32_t i = neighbors.start[v]; i < neighbors.start[v + 1]; ++i) w.vertex[v] += w.edge[i];
  }
  return w;
}

}  // namespace cei3d
