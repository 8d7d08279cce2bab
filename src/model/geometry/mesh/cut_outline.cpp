// SPDX-License-Identifier: Apache-2.0
#include "model/geometry/mesh/cut_outline.h"

#include <algorithm>
#include <map>

#include "model/geometry/mesh/adjacency.h"
#include "model/geometry/mesh/areas.h"

namespace cei3d {
namespace {

constexpr int kSmoothingRounds = 4;
constexpr double kIslandShare = 0.02;  // maximum area of an island, as a share of the part's

using Triangle = std::array<uint32_t, 3>;

// Averages over neighbors, then takes the majority: outlines shorten like a curve under tension.
std::vector<uint8_t> smooth(const VertexLists& neighbors, std::span<const uint8_t> labels) {
  std::vector<float> now(labels.begin(), labels.end()), next(now.size());
  for (int round = 0; round < kSmoothingRounds; ++round) {
    for (uint32_t v = 0; v < now.size(); ++v) {
      float sum = now[v];
      for (const uint32_t u : neighbors.of(v)) sum += now[u];
      next[v] = sum / float(1 + neighbors.of(v).size());
    }
    now.swap(next);
  }
  std::vector<uint8_t> out(now.size());
  for (size_t v = 0; v < now.size(); ++v) out[v] = now[v] >= 0.5f;
  return out;
}

// Flips connected components of that label whose area is below `min_area` and that border on the other label.
void flip_islands(const VertexLists& neighbors, const std::vector<double>& area, uint8_t label,
                  double min_area, std::vector<uint8_t>& labels) {
  std::vector<uint8_t> seen(labels.size(), 0);
  std::vector<uint32_t> island;
  for (uint32_t start = 0; start < labels.size(); ++start) {
    if (labels[start] != label || seen[start]) continue;
    island.assign(1, start);
    seen[start] = 1;
    double size = 0;
    bool borders = false;
    for (size_t i = 0; i < island.size(); ++i) {
      size += area[island[i]];
      for (const uint32_t u : neighbors.of(island[i])) {
        borders |= labels[u] != label;
        if (labels[u] != label || seen[u]) continue;
        seen[u] = 1;
        island.push_back(u);
      }
    }
    if (borders && size < min_area)
      for (const uint32_t v : island) labels[v] = !label;
  }
}

// Edges that only one remaining triangle has and a removed one had, as successor of each vertex.
std::multimap<uint32_t, uint32_t> open_edges(const Mesh& mesh, const std::vector<uint8_t>& removed) {
  std::vector<uint8_t> sides(mesh.positions.size(), 0);  // of the outline on which a vertex has triangles
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    for (const uint32_t v : mesh.triangles[i]) sides[v] |= removed[i] ? 1 : 2;
  std::map<std::pair<uint32_t, uint32_t>, int> gone, kept;  // a -> b, less b -> a; a < b
  for (size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k) {
      const uint32_t a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
      if ((sides[a] & sides[b]) != 3) continue;
      (removed[i] ? gone : kept)[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  std::multimap<uint32_t, uint32_t> next;
  for (const auto& [edge, flow] : gone) {
    const auto left = kept.find(edge);
    if (flow == 0 || left == kept.end() || left->second * flow >= 0) continue;
    if (flow > 0)
      next.emplace(edge.first, edge.second);
    else
      next.emplace(edge.second, edge.first);
  }
  return next;
}

bool widen_at_pinches(const VertexLists& around, const std::multimap<uint32_t, uint32_t>& next,
                      std::vector<uint8_t>& removed) {
  bool any = false;
  for (auto it = next.begin(); it != next.end(); it = next.upper_bound(it->first)) {
    if (next.count(it->first) < 2) continue;
    for (const uint32_t t : around.of(it->first)) removed[t] = 1;
    any = true;
  }
  return any;
}

std::vector<std::vector<uint32_t>> chain(std::multimap<uint32_t, uint32_t> next) {
  std::vector<std::vector<uint32_t>> loops;
  while (!next.empty()) {
    std::vector<uint32_t> loop;
    for (auto at = next.begin(); at != next.end(); at = next.find(loop.back())) {
      if (loop.empty()) loop.push_back(at->first);
      loop.push_back(at->second);
      next.erase(at);
    }
    if (loop.front() == loop.back()) loop.pop_back();
    if (loop.size() >= 3) loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace

std::vector<uint8_t> clean_labels(const Mesh& mesh, std::span<const uint8_t> in_part) {
  const VertexLists neighbors = neighbors_of(mesh.positions.size(), mesh.triangles);
  const std::vector<double> area = vertex_areas(mesh);
  const auto size_of = [&](std::span<const uint8_t> labels) {
    double sum = 0;
    for (size_t v = 0; v < labels.size(); ++v) sum += labels[v] ? area[v] : 0;
    return sum;
  };
  const double size = size_of(in_part);
  std::vector<uint8_t> labels = smooth(neighbors, in_part);
  if (size_of(labels) < 0.8 * size)
    labels.assign(in_part.begin(), in_part.end());  // thin part: smoothing would remove it
  flip_islands(neighbors, area, 0, kIslandShare * size, labels);
  flip_islands(neighbors, area, 1, kIslandShare * size, labels);
  return labels;
}

Outline outline_of(const Mesh& mesh, std::span<const uint8_t> in_part) {
  Outline outline{std::vector<uint8_t>(mesh.triangles.size()), {}};
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto [a, b, c] = mesh.triangles[i];
    outline.removed[i] = in_part[a] + in_part[b] + in_part[c] >= 2;
  }
  const VertexLists around = triangles_around(mesh.positions.size(), mesh.triangles);
  auto next = open_edges(mesh, outline.removed);
  while (widen_at_pinches(around, next, outline.removed)) next = open_edges(mesh, outline.removed);
  outline.loops = chain(std::move(next));
  return outline;
}

}  // namespace cei3d
